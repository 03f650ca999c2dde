// Makes a closed surface a manifold: where two of its sheets meet in an edge or a vertex, the edge or vertex
// is duplicated, so that every edge has exactly two triangles and every vertex one fan.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// A triangle and its origin. Where more than two triangles meet in an edge, those of the same part belong
/// together, then those of the same cell (part / 8).
struct PartTriangle {
  std::array<int, 3> vertices{};
  std::int64_t part = 0;
};

struct Manifold {
  std::vector<Vec3i> triangles;
  /// #V, the two vertices of the input whose mean each vertex is. Both are the same except for a vertex
  /// inserted in the middle of an edge.
  std::vector<std::array<int, 2>> sources;
};

/// `triangles` must be closed: each edge is traversed equally often in both directions.
Manifold make_manifold(const std::vector<PartTriangle>& triangles);

}  // namespace muslin
