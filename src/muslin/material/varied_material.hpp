// A material whose numbers vary, at one place and time.
#pragma once

#include <span>

#include "muslin/material/material.hpp"

namespace muslin {

/// Why densities have no keyframes, for messages.
inline constexpr const char* steady_density =
    "mass would appear or vanish; give keyframes to a gravity force with this `body`";

/// Return the material with these numbers in place of its varying ones, in the order of its `variations`, and
/// with the numbers that follow from them. The result has no variations.
Material with_numbers(const Material& material, std::span<const double> values);
ShellMaterial with_numbers(const ShellMaterial& material, std::span<const double> values);

}  // namespace muslin
