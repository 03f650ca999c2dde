// SeparateParts keeps solids of one mesh that are nearer than a voxel apart: in the grid of the lattice each
// lies in a slab of its own, moved away from the others by whole voxels.
#pragma once

#include <optional>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/lattice/lattice.hpp"

namespace muslin {

class SeparateParts {
 public:
  /// Moves nothing.
  SeparateParts() = default;
  /// Stacks the solids of a mesh along its longest side, in the order of their first vertices. The first
  /// stays where it is. Moves nothing if there is only one.
  SeparateParts(const Mesh& solid, const LatticeSettings& settings);

  bool empty() const { return offsets_.empty(); }
  std::size_t count() const { return offsets_.size(); }
  /// Returns the mesh of the constructor where its solids lie in the grid.
  Mesh in_grid(Mesh solid) const;
  /// Returns points where they lie in the grid [m]: moved with the solid whose surface is nearest.
  std::vector<Vec3> in_grid(ConstVectors points) const;
  /// Returns the slabs of a lattice of the moved mesh.
  std::vector<LatticeSlab> slabs(const Lattice& lattice) const;

 private:
  std::optional<ClosestPointQuery> surface_;
  std::vector<int> of_vertex_, of_triangle_;  // the solid of each vertex and triangle of surface_
  std::vector<Vec3> offsets_;                 // of each solid [m]
  std::vector<double> begins_;  // of each solid: where its slab begins along the axis in the grid [m]
  int axis_ = 0;
};

}  // namespace muslin
