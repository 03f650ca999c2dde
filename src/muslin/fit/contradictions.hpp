// Finds measurements of one quantity that contradict each other.
#pragma once

#include <string>
#include <vector>

#include "muslin/fit/measurements.hpp"

namespace muslin {

/// Returns a warning for each quantity whose measurements differ by more than their uncertainties allow: χ²
/// about their weighted mean exceeds what chance exceeds once in 740 cases. It names the two that differ
/// most. A measurement without an uncertainty is taken to be known to 10 %.
std::vector<std::string> contradictions(const Measurements& measurements);

}  // namespace muslin
