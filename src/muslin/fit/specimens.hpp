// Compares the curves of several specimens.
#pragma once

#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/fit/measurements.hpp"

namespace muslin {

/// Returns a factor for each curve: times the curve fitted to all of them, it is nearest to that curve in the
/// sense of least squares. Errors: none; every curve has a point with a force.
std::vector<double> specimen_factors(const std::vector<std::vector<Vec2>>& curves);

/// States the uncertainties of the factors of specimens whose tests do not: the scatter between specimens of
/// the same direction.
void estimate_scatter(Measurements& measurements);

/// Returns how far `other` is from a curve: the root of the sum of squared differences at the points of the
/// curve, over that of its forces.
double relative_change(const std::vector<Vec2>& curve, const std::vector<Vec2>& other);

}  // namespace muslin
