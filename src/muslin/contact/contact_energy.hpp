// Defines the scalar laws of contact and friction.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace muslin {

/// A value with its first and second derivative.
struct Law {
  double value = 0, slope = 0, curvature = 0;
};

/// Energy b(g) of a gap g [m] for stiffness 1 N/m: a spring at the range d̂ [m] that stiffens without bound
/// towards zero.
///
///   g ≥ d̂      0
///   g > 0      ½ (d̂ − g)² d̂/g        slope −½ d̂ ((d̂/g)² − 1),   curvature (d̂/g)³
///   else       ∞
///
/// Under a force of f d̂ [N] the gap is about d̂/√(2f), and the curvature is twice the force over the gap.
/// Under a logarithmic barrier (Li et al., Incremental Potential Contact, 2020) the gap falls as 1/f. A heavy
/// load then makes the gap so small that Newton's method, whose steps can hardly more than double a gap,
/// needs many iterations to recover (docs/theory/contact.md).
inline Law contact_law(double gap, double range) {
  if (gap >= range) return {};
  if (!(gap > 0)) {
    const double infinite = std::numeric_limits<double>::infinity();
    return {infinite, -infinite, infinite};
  }
  const double depth = range - gap, ratio = range / gap;
  return {0.5 * depth * depth * ratio, -0.5 * range * (ratio * ratio - 1), ratio * ratio * ratio};
}

/// Friction for a limit force μ N of 1 N, as an energy of the slip length s ≥ 0 [m]: smooth below `stick`
/// [m], the work of the full force beyond (Li et al., Incremental Potential Contact, 2020, f₁).
///
///   y = s/stick < 1    stick (y² − y³/3)          force 2y − y²
///   else               s − stick/3                force 1
///
/// `curvature` is the secant force/s, which is never less than the derivative. The quadratic with this
/// curvature that touches the energy at s is an upper bound: its steps need no line search, while the true
/// curvature, zero where surfaces slide, makes them overshoot the sticking range. Near the minimum they
/// converge faster with the true one.
inline Law friction_law(double slip, double stick) {
  const double y = slip / stick;
  if (y >= 1) return {slip - stick / 3, 1, 1 / slip};
  return {stick * y * y * (1 - y / 3), y * (2 - y), (2 - y) / stick};
}

}  // namespace muslin
