// A material whose numbers vary, at one place and time.
#pragma once

#include <span>

#include "muslin/material/material.hpp"

namespace muslin {

/// Return the material with these numbers in place of its varying ones, in the order of its `variations`, and
/// with the numbers that follow from them. The result has no variations.
Material with_numbers(const Material& material, std::span<const double> values);
ShellMaterial with_numbers(const ShellMaterial& material, std::span<const double> values);

}  // namespace muslin
