// Computes the mean edge length of a surface.
#pragma once

#include <limits>
#include <span>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Returns the mean length [m] of all sides of the triangles (#T by 3, indices into positions); infinity if
/// there are none.
inline double mean_edge(ConstVectors positions, std::span<const Vec3i> triangles) {
  if (triangles.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const Vec3i& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      const int next = t[(i + 1) % 3];
      sum += (positions[static_cast<std::size_t>(t[i])] - positions[static_cast<std::size_t>(next)]).norm();
    }
  }
  return sum / static_cast<double>(3 * triangles.size());
}

}  // namespace muslin
