// The scalar laws of contact and friction.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace muslin {

/// A value with its first and second derivative.
struct Law {
  double value = 0, slope = 0, curvature = 0;
};

/// Energy b(g) of a gap g [m] for stiffness 1 N/m: a spring within the range d̂ [m], and within τ = d̂/2 some
/// of a barrier as well (Li et al., Incremental Potential Contact, 2020, eq. 6), without bound at zero; twice
/// continuously differentiable.
///
///   g ≥ d̂      0
///   g ≥ τ      ½ (d̂ − g)²
///   g > 0      ½ (d̂ − g)² − β (τ − g)² ln(g/τ),   β = 0.2
///   else       ∞
///
/// A weak barrier is enough, because nothing relies on it to keep surfaces apart; a strong one takes many
/// iterations where folds meet at speed (docs/theory/contact.md).
inline Law contact_law(double gap, double range) {
  constexpr double beta = 0.2;
  if (gap >= range) return {};
  Law law = {(range - gap) * (range - gap) / 2, gap - range, 1};
  const double near = range / 2;
  if (gap >= near) return law;
  if (!(gap > 0)) {
    const double infinite = std::numeric_limits<double>::infinity();
    return {infinite, -infinite, infinite};
  }
  const double depth = near - gap, log = std::log(gap / near), steep = depth / gap;
  law.value -= beta * depth * depth * log;
  law.slope += beta * depth * (2 * log - steep);
  law.curvature += beta * (steep * (4 + steep) - 2 * log);
  return law;
}

/// Friction for a limit force μ N of 1 N, as an energy of the slip length s ≥ 0 [m]: smooth below `stick`
/// [m], the work of the full force beyond (Li et al., Incremental Potential Contact, 2020, f₁).
///
///   y = s/stick < 1    stick (y² − y³/3)          force 2y − y²
///   else               s − stick/3                force 1
///
/// `curvature` is the secant force/s, which is never less than the derivative: what a lagged, positive
/// semidefinite Hessian takes.
inline Law friction_law(double slip, double stick) {
  const double y = slip / stick;
  if (y >= 1) return {slip - stick / 3, 1, 1 / slip};
  return {stick * y * y * (1 - y / 3), y * (2 - y), (2 - y) / stick};
}

}  // namespace muslin
