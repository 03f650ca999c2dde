// Reads tables of two columns, as testers export them.
#pragma once

#include <filesystem>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

inline constexpr double largest_measured = 1e9;  ///< larger numbers are refused

/// A point and its line in the file, counted from 1.
struct PointRow {
  Vec2 point;
  int line = 0;
};

/// Returns the rows of a text file of two numbers each, separated by commas, semicolons, tabs or blanks.
/// Lines before the first number (titles of columns), empty lines and those that begin with # are skipped.
/// Errors: file; input with the line.
std::vector<PointRow> read_points(const std::filesystem::path& file);

}  // namespace muslin
