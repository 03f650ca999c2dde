// The rigidity that a bending test of one number means.
#pragma once

#include <optional>

#include "muslin/fit/measurements.hpp"

namespace muslin {

/// Returns the bending rigidity [N·m] of cloth of this areal density [kg/m²] by the test; none if it states
/// points. Errors: input, with the test's place, if no rigidity makes its loop.
std::optional<double> rigidity_by(const BendingTest& test, double areal_density);

}  // namespace muslin
