// Finds the triangles of a surface that cross each other: the reference for contact. Shares no code with the
// contact search, the distances or the step limiter.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Two triangles that share a point which is not a vertex or edge of both.
struct Intersection {
  int first = 0, second = 0;  ///< triangles, first < second
  Vec3 at = Vec3::Zero();     ///< where, to rounding [m]
};

struct IntersectionOptions {
  /// Most intersections to find; these are the first of the full list.
  std::size_t limit = std::numeric_limits<std::size_t>::max();
  /// Pairs for which this returns false are left out, such as triangles of two fixed colliders; empty: none.
  /// Called by several threads.
  std::function<bool(int, int)> wanted;
};

/// Returns all pairs of triangles (#T by 3, indices into positions, #V by 3) that meet, in ascending order.
/// Exact: touching counts, and so do triangles in one plane. Triangles that share a vertex or an edge (by
/// index) count if they meet elsewhere too; triangles with the same three vertices always do. Repeated
/// indices make a segment or a point. Errors: usage, if a position is not finite or an index out of range.
std::vector<Intersection> find_intersections(ConstVectors positions, std::span<const Vec3i> triangles,
                                             const IntersectionOptions& options = {});

}  // namespace muslin
