// Writes numbers with units for people.
#pragma once

#include <string>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Returns three significant digits and the unit with a prefix that suits: "120 µm", "3.4 kJ". Powers of
/// ten from 1e-12 to 1e9 have prefixes.
std::string quantity(double value, const std::string& unit);

/// Returns "(0.1, 0.25, -0.3) m".
std::string position_text(const Vec3& at);

}  // namespace muslin
