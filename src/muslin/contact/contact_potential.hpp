// Contact and friction as a potential of the degrees of freedom q, surfaces being x = J q:
//
//   W(q) = Σ k wₚ b(gₚ(x)) + Σ μ λₚ f(|eₚ(x)|)
//
// over pairs p of features with gap g = distance − thickness, b and f as in contact_energy.hpp, k the smaller
// stiffness of the two bodies.
//
// Shares w count every contact once. A vertex that is nearest to an edge or corner of triangles meets all of
// them: each gets its share. Edges count only where they cross in their interiors, fading out towards their
// ends and towards being parallel: there vertices against triangles do it all. Shares, friction's normal
// force λ, normal and closest points are taken at the q the potential is made for, and are then constant
// (lagged, as the friction of Li et al., Incremental Potential Contact, 2020): make it anew in each
// iteration.
//
// Friction remembers. e is the slip since contact began, cut to `stick_length`: a spring that holds, so that
// what rests does not creep (bristle model; Haessig, Friedland 1991), and the smoothed Coulomb force where it
// slips. What slips over a round body is its surface, which turns: the point of a ball that touches is
// carried by the ball's frame, as an affine combination of its four vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/contact/pair_distances.hpp"
#include "muslin/contact/surface_map.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

struct Friction {
  double coefficient = 0;      ///< Coulomb's μ of bodies without one of their own
  double stick_length = 4e-6;  ///< slip at which friction is full [m]: ε_v dt, for instance 1 mm/s · 1/240 s
};

/// The slip of a pair that sticks or slides, by ContactPair::key(); part of the moving state.
struct PairSlip {
  std::uint64_t key = 0;
  Vec3 slip = Vec3::Zero();  ///< of the first feature over the second, no longer than stick_length [m]
};

class ContactPotential : public Potential {
 public:
  /// For q near `lagged` (#V by 3, [m]), within the boxes of the candidates; `distances` are those at
  /// J `lagged`. `start` (#V by 3, [m]) are the positions at the beginning of the step, `slips` those of the
  /// step before, by ascending key. Pairs without a gap at `lagged` are left free. Errors: usage, if a
  /// coefficient is negative or sizes do not fit.
  ContactPotential(const PairDistances& distances, std::shared_ptr<const SurfaceMap> map, ConstVectors lagged,
                   Friction friction, ConstVectors start, std::span<const PairSlip> slips = {});

  double value(ConstVectors q) const override;
  void add_gradient(ConstVectors q, Vectors g) const override;
  /// Of k w b″ n nᵀ and the secant of friction: positive semidefinite. Left out is b′ ∂²g/∂x², which is
  /// negative, and the change of normals.
  void add_hessian_product(ConstVectors q, ConstVectors p, Vectors y) const override;
  void add_diagonal_blocks(ConstVectors q, std::span<Mat3> blocks) const override;
  void linearize(ConstVectors q, Linearization& into, std::size_t first) const override;
  /// Keeps a tenth of every gap.
  double max_step(ConstVectors q, ConstVectors d) const override;

  /// The two sums of W: what pressed surfaces store, and what friction takes.
  struct Parts {
    double pressed = 0, rubbed = 0;
    Parts operator+(const Parts& other) const { return {pressed + other.pressed, rubbed + other.rubbed}; }
  };
  Parts parts(ConstVectors q) const;

  /// Pairs with some share that are or may come into range.
  std::size_t pair_count() const { return pairs_.size(); }
  /// What the next step starts from, when this one ends at q; by ascending key.
  std::vector<PairSlip> slips(ConstVectors q) const;

 private:
  struct Pair {
    ContactPair pair;
    PairGeometry lagged;              ///< where the potential was made
    double stiffness = 0;             ///< k w
    double friction = 0;              ///< μ λ, 0 if out of contact [N]
    Vec3 normal;                      ///< of friction
    std::array<double, 4> weights{};  ///< of friction
    Vec3 begin;        ///< slip is the tangential part of Σ weights x + Σ carried q − begin
    int carried = -1;  ///< which of carried_, −1: none
  };
  /// Material points of the two features, as far as they are of turning bodies.
  struct Carried {
    std::array<SurfaceMap::Entry, 8> entries;
    std::size_t count = 0;
    std::span<const SurfaceMap::Entry> span() const { return {entries.data(), count}; }
  };
  class Hessian;

  /// Positions of the surface points: q itself or `buffer`, filled.
  ConstVectors points(ConstVectors q, std::vector<Vec3>& buffer) const;
  /// Pairs at x; asked for most often where their geometry was lagged, and then known.
  class Geometries;
  void carry(Pair& pair, const PairGeometry& at, ConstVectors x, ConstVectors q, Carried& carried) const;
  std::span<const SurfaceMap::Entry> carried(const Pair& pair) const;
  Vec3 relative(const Pair& pair, ConstVectors x, ConstVectors q) const;
  Vec3 slip(const Pair& pair, ConstVectors x, ConstVectors q) const;

  std::shared_ptr<const ContactSurface> surface_;
  std::shared_ptr<const SurfaceMap> map_;
  Friction friction_;
  std::vector<Vec3> lagged_;  ///< points where the potential was made
  std::vector<Pair> pairs_;
  std::vector<Carried> carried_;
  // The pairs at each point: 4 · pair + place, by point.
  std::vector<int> offsets_, places_;
};

}  // namespace muslin
