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

/// Energy b(g) of a gap g [m] for stiffness 1 N/m: a spring within the range d̂ [m], a logarithm within half
/// of it, joined with continuous second derivative at τ = d̂/2; without bound at zero. Two-stage as in Li,
/// Kaufman, Jiang, Codimensional Incremental Potential Contact (2021), and in the prototype this follows.
///
///   g ≥ d̂      0
///   g ≥ τ      ½ (d̂ − g)²
///   g > 0      ½ τ² − τ² ln(g/τ)
///   else       ∞
inline Law contact_law(double gap, double range) {
  if (gap >= range) return {};
  const double half = range / 2;
  if (gap >= half) return {(range - gap) * (range - gap) / 2, gap - range, 1};
  if (!(gap > 0)) {
    const double infinite = std::numeric_limits<double>::infinity();
    return {infinite, -infinite, infinite};
  }
  const double square = half * half;
  return {square / 2 - square * std::log(gap / half), -square / gap, square / (gap * gap)};
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
