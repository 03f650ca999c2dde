// Computes the shares of voxels that a solid fills, by sampling; for meshes whose volume cannot be computed
// exactly.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/winding_number.hpp"
#include "muslin/lattice/surface_pieces.hpp"

namespace muslin {

/// The winding number is evaluated once in each octant of a voxel. From there to a sample it changes by one
/// at each triangle in between, and otherwise hardly within an octant: not at all if the mesh is closed.
class FillSampler {
 public:
  /// `triangles` (#T by 3) index `positions` (#V by 3) and face outward (geometry/orientation.hpp).
  FillSampler(ConstVectors positions, std::span<const Vec3i> triangles, const VoxelKeys& grid);

  /// Returns the share of 8³ sample points of the voxel that are inside the solid.
  double operator()(const Vec3i& voxel) const;

 private:
  struct Triangle {
    Vec3 a, b, c;
  };
  void note(int triangle, const Vec3i& low, const Vec3i& high);
  double octant(const Vec3& centre, double width, const std::vector<Triangle>& near) const;

  VoxelKeys grid_;
  std::vector<Triangle> triangles_;
  WindingNumber winding_;
  std::vector<std::pair<std::uint64_t, int>> meets_;  // a voxel and a triangle that meets it, ascending
};

}  // namespace muslin
