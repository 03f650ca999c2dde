// Finds triangles that are turned over in the rest shape of a shell.
#pragma once

#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Returns the triangles (#T by 3) that a vertex on the wrong side turns over at `rest` (#V by 3), ascending:
/// up to four neighbours, and around them the sheet is folded flat. Larger parts are folds that are meant.
std::vector<int> inverted_triangles(std::span<const Vec3i> triangles, ConstVectors rest);

}  // namespace muslin
