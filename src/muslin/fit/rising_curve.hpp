// Fits the curve of a material to measured points that scatter.
#pragma once

#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

struct RisingCurve {
  std::vector<Vec2> points;  ///< of a StressCurve
  double residual = 0;       ///< root of the squares of what is left over those of the data
};

/// Fits a StressCurve through the origin (energy/stress_curve.hpp) to points (x ≥ 0, y ≥ 0) of any number of
/// specimens, in the sense of least squares. It passes at most StressCurve::most_points points, spread as the
/// data are, and rises everywhere, so that its integral is a convex energy. At least one point has x > 0 and
/// y > 0.
RisingCurve fit_rising_curve(std::vector<Vec2> data);

/// Returns the x ≥ 0 least squares solution of a x = b (Lawson, Hanson, Solving least squares problems, 1974,
/// chapter 23).
std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& a,
                                               const std::vector<double>& b);

}  // namespace muslin
