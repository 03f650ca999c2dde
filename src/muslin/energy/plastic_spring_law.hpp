// PlasticSpringLaw is a spring that takes a set: with its strain ε, the plastic strain ε_p, e = ε − ε_p, the
// yield strain y and the share h of the stiffness that is left beyond yield, a step minimises over the slip
// s ≥ 0, in the direction of e,
//
//   ψ = ½ h k ε² + (1 − h) (½ k (|e| − s)² + k y s),   s = max(0, |e| − y):
//
// its last term is lost, the others are stored. For bars. docs/theory/plasticity.md.
#pragma once

#include <array>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"

namespace muslin {

struct PlasticSpringLaw {
  struct Constants {
    double stiffness;  // k: spring constant times the square of the rest length [J]
    double yield;      // y
    double hardening;  // h
    double plastic;    // ε_p at the beginning of the step
  };

  MUSLIN_INLINE static double slip(const Constants& c, double strain) {
    const double e = strain - c.plastic, excess = (e < 0 ? -e : e) - c.yield;
    return excess > 0 ? excess : 0;
  }
  /// e without the slip.
  MUSLIN_INLINE static double elastic(const Constants& c, double strain) {
    const double e = strain - c.plastic, s = slip(c, strain);
    return e < 0 ? e + s : e - s;
  }
  MUSLIN_INLINE static double dissipated(const Constants& c, double strain) {
    return (1 - c.hardening) * c.stiffness * c.yield * slip(c, strain);
  }

  MUSLIN_INLINE static double energy(const Constants& c, double strain) {
    const double e = elastic(c, strain);
    return 0.5 * c.stiffness * (c.hardening * strain * strain + (1 - c.hardening) * e * e) +
           dissipated(c, strain);
  }
  MUSLIN_INLINE static double tension(const Constants& c, double strain) {
    return c.stiffness * (c.hardening * strain + (1 - c.hardening) * elastic(c, strain));
  }
  MUSLIN_INLINE static double slope(const Constants& c, double strain) {
    return slip(c, strain) > 0 ? c.hardening * c.stiffness : c.stiffness;
  }
};

}  // namespace muslin
