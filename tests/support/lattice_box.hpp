// A box of voxels, for tests that need a lattice and no mesh.
#pragma once

#include <array>
#include <vector>

#include "muslin/lattice/lattice.hpp"
#include "muslin/lattice/springs.hpp"

namespace muslin::test {

/// nx × ny × nz voxels with a corner at the origin; voxels and vertices sorted by (j,k,i), as Lattice says.
inline Lattice box_lattice(const Vec3i& extent, double width = 1) {
  Lattice lattice;
  lattice.width = width;
  lattice.extent = extent;
  const Vec3i size = extent + Vec3i::Ones();
  const auto vertex = [&](int i, int j, int k) { return (j * size.z() + k) * size.x() + i; };
  for (int j = 0; j < size.y(); ++j) {
    for (int k = 0; k < size.z(); ++k) {
      for (int i = 0; i < size.x(); ++i) lattice.vertices.emplace_back(i, j, k);
    }
  }
  for (int j = 0; j < extent.y(); ++j) {
    for (int k = 0; k < extent.z(); ++k) {
      for (int i = 0; i < extent.x(); ++i) {
        lattice.voxels.emplace_back(i, j, k);
        lattice.fill.push_back(1);
        std::array<int, 8> corners;
        for (int c = 0; c < 8; ++c) {
          corners[static_cast<std::size_t>(c)] = vertex(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
        }
        lattice.voxel_vertices.push_back(corners);
      }
    }
  }
  return lattice;
}

inline std::vector<Vec3> rest_positions(const Lattice& lattice) {
  std::vector<Vec3> x;
  for (std::size_t v = 0; v < lattice.vertex_count(); ++v) x.push_back(lattice.rest_position(v));
  return x;
}

}  // namespace muslin::test
