// PlasticHingeLaw is an elastic, plastic hinge with isotropic linear hardening. With the plastic angle θ_p
// and the sum α of all slips so far, e = w − θ_p, and the yield angle θ_y + h α, a step minimises over the
// slip s ≥ 0
//
//   ψ = ½ k (|e| − s)² + k (θ_y + h α) s + ½ k h s²
//
// (a variational update: Ortiz, Stainier, The variational formulation of viscoplastic constitutive updates,
// 1999), so that s = max(0, |e| − θ_y − h α)/(1 + h). The first term is stored, the others are lost. h = 0 is
// ideal plasticity.
#pragma once

#include <array>
#include <limits>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"

namespace muslin {

struct PlasticHingeLaw {
  struct Constants {
    double stiffness;  // k [N·m]
    double yield;      // θ_y
    double hardening;  // h
    double plastic;    // θ_p at the beginning of the step
    double slipped;    // α
  };
  static constexpr bool linear = false;

  static constexpr double none = std::numeric_limits<double>::infinity();
  static constexpr std::array<LawParameter, 2> parameters = {{
      {"yield_angle", "rad", 0, none, false, "Angle from rest beyond which a hinge stays bent."},
      {"hardening", "", 0, none, false, "Growth of the yield angle per angle of slip."},
  }};

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

}  // namespace muslin
