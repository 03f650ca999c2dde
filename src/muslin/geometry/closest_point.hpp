// ClosestPointQuery finds the point of a triangle mesh nearest to a given point.
//
// It uses a tree of boxes, each oriented to fit the patch of surface in it (Gottschalk, Lin, Manocha,
// OBBTree, 1996): a box around a flat patch is thin, so far fewer triangles are tested than with axis-aligned
// boxes. The distance to one triangle follows Ericson, Real-Time Collision Detection (2005), §5.1.5, and is
// made safe for needles. All arithmetic is in double.
#pragma once

#include <limits>
#include <memory>
#include <span>

#include "muslin/core/vectors.hpp"

namespace muslin {

struct ClosestPoint {
  int triangle = -1;                                          ///< −1 if none lies within the search distance
  double distance = std::numeric_limits<double>::infinity();  ///< [m], ≥ 0
  Vec3 point = Vec3::Zero();                                  ///< on the triangle [m]
  Vec3 barycentric = Vec3::Zero();                            ///< weights of its corners, ≥ 0, sum 1
};

/// Safe to call from several threads. Answers depend on the mesh alone, not on how the tree was built: among
/// triangles at exactly the same distance the one of smallest index wins.
class ClosestPointQuery {
 public:
  /// `triangles` (#T by 3) index `positions` (#V by 3), which must be finite. Zero-area triangles count as
  /// segments or points.
  ClosestPointQuery(ConstVectors positions, std::span<const Vec3i> triangles);
  ~ClosestPointQuery();
  ClosestPointQuery(ClosestPointQuery&&) noexcept;
  ClosestPointQuery& operator=(ClosestPointQuery&&) noexcept;

  /// Searches up to `max_distance`. A good `hint`, such as the answer for a point close by, only makes it
  /// faster. Errors: usage, if the point is not finite.
  ClosestPoint operator()(const Vec3& point, double max_distance = std::numeric_limits<double>::infinity(),
                          int hint = -1) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace muslin
