// ContactPotential is the potential of contact and friction in the degrees of freedom q, with surface points
// x = J q:
//
//   W(q) = Σ kₜ b(dₜ(x) − thicknessₜ) + Σ μ λₚ f(|eₚ(x)|)
//
// The first sum runs over the terms of contact_terms.hpp; b and f are those of contact_energy.hpp, kₜ the
// smaller stiffness of the two bodies times the term's coefficient.
//
// The normal force λ, the normal and the closest points of friction are taken at the q for which the
// potential is made and are then constant (lagged, as in Li et al., Incremental Potential Contact, 2020):
// construct a new potential in each iteration. Friction has memory: e is the slip since contact began,
// limited to `stick_length`. It acts as a spring while sticking, so that bodies at rest do not creep (bristle
// model; Haessig, Friedland 1991), and as the smoothed Coulomb force while slipping. A vertex that moves to
// the next triangle keeps its slip. The slip over a round body is relative to its rotating surface: the
// touching point of a ball moves with the ball's frame, as an affine combination of its four vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/contact/contact_hessian.hpp"
#include "muslin/contact/contact_terms.hpp"
#include "muslin/contact/pair_distances.hpp"
#include "muslin/contact/surface_map.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/potential/stopping_time.hpp"

namespace muslin {

struct Friction {
  double coefficient = 0;      ///< Coulomb's μ at `time` of bodies without their own
  double stick_length = 1e-5;  ///< slip at which friction is full [m]
  double dt = stopping_time;   ///< time in which contact stops rigid bodies [s]
  double time = 0;             ///< at which μ is taken: the end of the step [s]
};

/// Slip of a sticking or sliding pair, by ContactPair::key(); part of the state of a run.
struct PairSlip {
  std::uint64_t key = 0;
  Vec3 slip = Vec3::Zero();  ///< of the first feature over the second, at most stick_length [m]
};

/// The Hessian of friction beyond the stick length: the secant in all directions, or the tangent, which is 0
/// along the slip.
enum class SlidingStiffness { secant, tangent };

class ContactPotential : public Potential {
 public:
  /// For q near `lagged` (#V by 3, [m]), within the boxes of the candidates; `distances` are those at
  /// J `lagged`. `start` (#V by 3, [m]) are the positions at the beginning of the step, `slips` those of the
  /// step before, by ascending key. Pairs without a gap at `lagged` are ignored. Errors: usage, if a
  /// coefficient is negative or sizes do not fit.
  ContactPotential(const PairDistances& distances, std::shared_ptr<const SurfaceMap> map, ConstVectors lagged,
                   Friction friction, ConstVectors start, std::span<const PairSlip> slips = {});
  /// Takes normal forces, closest points and slips of friction from another potential of the same step.
  ContactPotential(const PairDistances& distances, std::shared_ptr<const SurfaceMap> map, ConstVectors lagged,
                   const ContactPotential& friction, SlidingStiffness sliding = SlidingStiffness::secant);

  double value(ConstVectors q) const override;
  void add_gradient(ConstVectors q, Vectors g) const override;
  /// Adds the positive curvatures k b″ n nᵀ and the secant of friction, or its tangent where it slides, which
  /// are positive semidefinite. The negative term b′ ∂²d/∂x² is left out.
  void add_hessian_product(ConstVectors q, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors q, std::span<Mat3> blocks) const override;
  void linearize(ConstVectors q, HessianSink& into, std::size_t first) const override;

  ContactHessian hessian(ConstVectors q) const { return hessian(q, sliding_); }
  /// Returns the Hessian with the secant of friction at the q the potential was made for.
  ContactHessian secant_hessian() const { return hessian(lagged_q_, SlidingStiffness::secant); }

  /// The two sums of W.
  struct Parts {
    double normal = 0, friction = 0;  ///< [J]
    Parts operator+(const Parts& other) const { return {normal + other.normal, friction + other.friction}; }
  };
  Parts parts(ConstVectors q) const;

  std::size_t term_count() const { return terms_.size(); }
  /// Returns the slips from which the next step starts if this one ends at q; by ascending key.
  std::vector<PairSlip> slips(ConstVectors q) const;

 private:
  /// Friction of one contact.
  struct FrictionTerm {
    MergedContact contact;            ///< where the potential was made
    double limit = 0;                 ///< μ λ [N]
    std::array<double, 4> weights{};  ///< of points that are not carried
    Vec3 begin;                       ///< slip is the tangential part of Σ weights x + Σ carried q − begin
    int carried = -1;                 ///< which of carried_, −1: none
  };
  /// Material points of features that belong to rotating bodies.
  struct Carried {
    std::array<SurfaceMap::Entry, 8> entries;
    std::size_t count = 0;
    std::span<const SurfaceMap::Entry> span() const { return {entries.data(), count}; }
  };

  /// Returns the positions of the surface points: q itself or `buffer`, filled.
  ConstVectors points(ConstVectors q, std::vector<Vec3>& buffer) const;
  /// Returns the contacts at x: `buffer`, filled, unless x is the lagged position.
  std::span<const MergedContact> contacts(ConstVectors x, std::vector<MergedContact>& buffer) const;
  void carry(FrictionTerm& sliding, ConstVectors x, ConstVectors q, Carried& carried) const;
  std::span<const SurfaceMap::Entry> carried(const FrictionTerm& sliding) const;
  Vec3 slip(const FrictionTerm& sliding, ConstVectors x, ConstVectors q) const;
  ContactHessian hessian(ConstVectors q, SlidingStiffness stiffness) const;
  void add_tilt(const MergedContact& contact, ConstVectors x, std::vector<ContactRow>& rows) const;

  ContactPotential(const PairDistances& distances, std::shared_ptr<const SurfaceMap> map, ConstVectors lagged,
                   Friction friction);

  std::shared_ptr<const ContactSurface> surface_;
  std::shared_ptr<const SurfaceMap> map_;
  Friction friction_;
  SlidingStiffness sliding_ = SlidingStiffness::secant;
  std::vector<Vec3> lagged_q_;  ///< where the potential was made
  std::vector<Vec3> lagged_;    ///< points there
  std::vector<ContactTerm> terms_;
  std::vector<MergedContact> contacts_;  ///< at lagged_
  std::vector<FrictionTerm> friction_terms_;
  std::vector<Carried> carried_;
};

}  // namespace muslin
