// Reads tables of two columns, as testers export them.
#pragma once

#include <filesystem>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

inline constexpr double largest_measured = 1e9;  ///< larger numbers are refused

/// Returns the rows of a text file of two numbers each, separated by commas, semicolons, tabs or blanks.
/// Lines before the first number (titles of columns), empty lines and those that begin with # are skipped.
/// Errors: file; input with the line.
std::vector<Vec2> read_points(const std::filesystem::path& file);

}  // namespace muslin
