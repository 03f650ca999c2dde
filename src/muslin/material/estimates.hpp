// Reads which numbers of a material file are estimates, not measurements.
#pragma once

#include <string>
#include <vector>

#include "muslin/core/toml_value.hpp"

namespace muslin {

/// Returns the numbers that the list `estimated` of a parsed material file names, such as
/// "shell.bending_warp"; none without a list. Errors: input, for a name that is no number of the file.
std::vector<std::string> estimated_numbers(const TomlValue& file);

}  // namespace muslin
