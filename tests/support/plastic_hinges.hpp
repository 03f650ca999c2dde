// PlasticHinges models the bending of a shell that keeps a fold, such as paper or foil. Each hinge stores its
// plastic angle and its slip (potential/history.hpp). Unlike the hinges of ShellBending these are not
// coupled:
//
//   W = Σ ψ(w(θ − θ₀)),   ψ'' = D l² / (A₁ + A₂) below the yield angle   [N·m]
//
// with l the length of the edge and A₁, A₂ the areas of the triangles at rest, and D the rigidity for bending
// across the edge, at the angle φ from warp,
//
//   D = D_warp cos⁴φ + D_weft sin⁴φ + (4 D_bias − D_warp − D_weft) cos²φ sin²φ.
//
// This is the rigidity of squares cut in two that bend along their sides (Grinspun, Hirani, Desbrun, Schröder
// 2003); on other meshes and in other directions it is 0.7 to 3 times as much. ν is not used.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "support/hinge_stencil.hpp"

#include "muslin/core/error.hpp"
#include "muslin/core/vector_code.hpp"
#include "muslin/energy/elements_methods.hpp"
#include "muslin/energy/hinge_coupling.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/energy/shell_pattern.hpp"
#include "muslin/potential/history.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin::test {

/// PlasticHingeLaw is an elastic, plastic hinge with isotropic linear hardening. With the plastic angle θ_p
/// and the sum α of all slips so far, e = w − θ_p, and the yield angle θ_y + h α, a step minimises over the
/// slip s ≥ 0
///
///   ψ = ½ k (|e| − s)² + k (θ_y + h α) s + ½ k h s²
///
/// (a variational update: Ortiz, Stainier, The variational formulation of viscoplastic constitutive updates,
/// 1999), so that s = max(0, |e| − θ_y − h α)/(1 + h). The first term is stored, the others are lost. h = 0
/// is ideal plasticity.
struct PlasticHingeLaw {
  struct Constants {
    double stiffness;  // k [N·m]
    double yield;      // θ_y
    double hardening;  // h
    double plastic;    // θ_p at the beginning of the step
    double slipped;    // α
  };
  static constexpr bool linear = false;

  MUSLIN_INLINE static double slip(const Constants& c, double w) {
    const double e = w - c.plastic, excess = (e < 0 ? -e : e) - (c.yield + c.hardening * c.slipped);
    return excess > 0 ? excess / (1 + c.hardening) : 0;
  }
  MUSLIN_INLINE static double dissipated(const Constants& c, double w) {
    const double s = slip(c, w);
    return c.stiffness * s * (c.yield + c.hardening * c.slipped + 0.5 * c.hardening * s);
  }
  MUSLIN_INLINE static double elastic(const Constants& c, double w) {
    const double e = w - c.plastic, s = slip(c, w);
    return e < 0 ? e + s : e - s;
  }

  MUSLIN_INLINE static double energy(const Constants& c, double w) {
    const double e = elastic(c, w);
    return 0.5 * c.stiffness * e * e + dissipated(c, w);
  }
  MUSLIN_INLINE static double moment(const Constants& c, double w) { return c.stiffness * elastic(c, w); }
  MUSLIN_INLINE static double curvature(const Constants& c, double w) {
    return slip(c, w) > 0 ? c.stiffness * c.hardening / (1 + c.hardening) : c.stiffness;
  }
};

struct YieldLimit {
  double angle = 0;      ///< θ_y ≥ 0 of a hinge
  double hardening = 0;  ///< h ≥ 0
};

class PlasticHinges : public Load {
 public:
  /// `name` is unique among the loads of a run and names the hinges' arrays in the history. `pattern` is the
  /// shell's block_pattern, or null. Errors: usage, if a modulus or the limit is negative.
  PlasticHinges(const std::string& name, const Shell& shell, const BendingModuli& moduli,
                const YieldLimit& limit, std::shared_ptr<const SymmetricPattern> pattern = nullptr);
  ~PlasticHinges() override;

  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

  /// Returns θ_p of every hinge, in a history of a run; empty before the first step.
  std::span<const double> plastic_angles(const History& history) const;

 private:
  class Energy;

  std::string plastic_name_, slip_name_;
  std::size_t count_;
  std::shared_ptr<const Energy> at_rest_;
};

inline double rigidity_across(const BendingModuli& m, double warp_share) {
  const double weft_share = 1 - warp_share;
  return m.warp * warp_share * warp_share + m.weft * weft_share * weft_share +
         (4 * m.bias - m.warp - m.weft) * warp_share * weft_share;
}

/// ψ'' of every hinge [N·m].
inline std::vector<double> hinge_stiffnesses(const Shell& shell, const BendingModuli& moduli) {
  require(moduli.warp >= 0 && moduli.weft >= 0, "a bending modulus is negative", "give 0 or more");
  std::vector<double> stiffnesses;
  for (const Hinge& hinge : shell.hinges)
    stiffnesses.push_back(std::max(0.0, rigidity_across(moduli, hinge.warp_share)) * hinge.length *
                          hinge.length / hinge.area);
  return stiffnesses;
}

/// The energy of one step.
class PlasticHinges::Energy : public Elements<HingeStencil, PlasticHingeLaw> {
 public:
  using Constants = PlasticHingeLaw::Constants;

  Energy(std::shared_ptr<const Slabs> slabs, const Shell& shell, std::vector<Constants> constants,
         std::shared_ptr<const SymmetricPattern> pattern)
      : Elements(slabs, HingeStencil(*slabs, shell), lanes(*slabs, constants), std::move(pattern)),
        hinges_(std::make_shared<const std::vector<Hinge>>(shell.hinges)),
        constants_(std::move(constants)) {}
  Energy(const Energy& other, std::vector<Constants> constants)
      : Elements(other, lanes(other.slabs(), constants)),
        hinges_(other.hinges_),
        constants_(std::move(constants)) {}

  double dissipated(ConstVectors x) const override {
    double sum = 0;
    for (std::size_t h = 0; h < constants_.size(); ++h)
      sum += PlasticHingeLaw::dissipated(constants_[h], deviation(h, x));
    return sum;
  }

  const std::vector<Constants>& constants() const { return constants_; }
  /// θ − θ₀ within −π … π.
  double deviation(std::size_t h, ConstVectors x) const {
    constexpr double turn = 2 * std::numbers::pi;
    const Hinge& hinge = (*hinges_)[h];
    const auto at = [&](std::size_t c) { return x[static_cast<std::size_t>(hinge.vertices[c])]; };
    const double difference = hinge_angle(at(0), at(1), at(2), at(3)) - hinge.angle;
    return difference - (difference > turn / 2 ? turn : 0) + (difference < -turn / 2 ? turn : 0);
  }

 private:
  static LawConstants<PlasticHingeLaw> lanes(const Slabs& slabs, const std::vector<Constants>& constants) {
    return LawConstants<PlasticHingeLaw>(slabs, [&](std::size_t h) { return constants[h]; });
  }

  std::shared_ptr<const std::vector<Hinge>> hinges_;
  std::vector<Constants> constants_;  // by hinge
};

inline PlasticHinges::PlasticHinges(const std::string& name, const Shell& shell, const BendingModuli& moduli,
                                    const YieldLimit& limit, std::shared_ptr<const SymmetricPattern> pattern)
    : plastic_name_(name + ".plastic_angle"), slip_name_(name + ".slip"), count_(shell.hinges.size()) {
  require(limit.angle >= 0 && limit.hardening >= 0, "a yield angle or hardening is negative",
          "give 0 or more");
  std::vector<Energy::Constants> constants;
  for (const double stiffness : hinge_stiffnesses(shell, moduli))
    constants.push_back({stiffness, limit.angle, limit.hardening, 0, 0});
  at_rest_ = std::make_shared<const Energy>(
      std::make_shared<const ElementSlabs<4>>(hinge_vertices(shell), shell.vertex_count()), shell,
      std::move(constants), std::move(pattern));
}

inline PlasticHinges::~PlasticHinges() = default;

inline std::unique_ptr<Potential> PlasticHinges::potential(const StepContext& step) const {
  std::vector<Energy::Constants> constants = at_rest_->constants();
  if (step.history != nullptr) {
    const std::span<const double> plastic = step.history->find(plastic_name_, count_),
                                  slip = step.history->find(slip_name_, count_);
    for (std::size_t h = 0; h < plastic.size(); ++h) constants[h].plastic = plastic[h];
    for (std::size_t h = 0; h < slip.size(); ++h) constants[h].slipped = slip[h];
  }
  return std::make_unique<Energy>(*at_rest_, std::move(constants));
}

inline void PlasticHinges::end_step(const Potential& potential, ConstVectors x, History& history) const {
  const Energy& energy = static_cast<const Energy&>(potential);
  std::vector<double> slips(count_);
  const std::span<double> plastic = history.get(plastic_name_, count_);
  for (std::size_t h = 0; h < count_; ++h) {
    const Energy::Constants& c = energy.constants()[h];
    const double w = energy.deviation(h, x);
    slips[h] = PlasticHingeLaw::slip(c, w);
    plastic[h] = c.plastic + (w < c.plastic ? -slips[h] : slips[h]);
  }
  const std::span<double> slipped = history.get(slip_name_, count_);
  for (std::size_t h = 0; h < count_; ++h) slipped[h] = energy.constants()[h].slipped + slips[h];
}

inline std::span<const double> PlasticHinges::plastic_angles(const History& history) const {
  return history.find(plastic_name_, count_);
}

}  // namespace muslin::test
