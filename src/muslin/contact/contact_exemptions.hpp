// ContactExemptions lists features that are free of contact because bodies are joined there.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// A point of a surface is free of a triangle: it and the edges and triangles that it belongs to do not touch
/// the triangle, its edges and its corners. Other features of these triangles still do.
struct ContactExemptions {
  std::vector<std::array<int, 2>> point_triangles;  ///< a point and a triangle of the surface, ascending
  std::vector<std::array<int, 2>> point_planes;     ///< a point of the surface and a plane

  bool empty() const { return point_triangles.empty() && point_planes.empty(); }
  /// True if a corner of one triangle is free of the other one; triangles are given by corners and number.
  bool has(const Vec3i& first_corners, int first, const Vec3i& second_corners, int second) const {
    const auto is_free = [&](int point, int triangle) {
      return std::binary_search(point_triangles.begin(), point_triangles.end(), std::array{point, triangle});
    };
    for (int i = 0; i < 3; ++i)
      if (is_free(first_corners[i], second) || is_free(second_corners[i], first)) return true;
    return false;
  }
};

/// Freedom of contact by parts of the surface.
struct FreeParts {
  std::vector<int> parts;  ///< #P, the part of the surface that a point belongs to
  std::vector<std::array<int, 2>>
      pairs;                 ///< parts that do not touch each other, smaller number first; ascending
  std::vector<int> free_of;  ///< #P, a part that a point does not touch; −1: none

  bool empty() const { return free_of.empty() && pairs.empty(); }
  /// True if two points are free of each other.
  bool has(int a, int b) const {
    const int of_a = parts[static_cast<std::size_t>(a)], of_b = parts[static_cast<std::size_t>(b)];
    const auto free = [&](int p, int part) {
      const int other = free_of[static_cast<std::size_t>(p)];
      return other >= 0 && other == part;
    };
    return free(a, of_b) || free(b, of_a) ||
           std::binary_search(pairs.begin(), pairs.end(),
                              std::array{std::min(of_a, of_b), std::max(of_a, of_b)});
  }
};

}  // namespace muslin
