// Lattice holds the voxels of a solid and their vertices, from which springs and tetrahedra are made.
//
// Integer coordinates (i,j,k) count voxels from `origin` along x, y, z; voxel (i,j,k) spans
// origin + width·[i,i+1]×[j,j+1]×[k,k+1]. Voxels and vertices are sorted by (j,k,i): x runs fastest, then z,
// then y, so that a row of neighbours along x is contiguous in memory.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/field/signed_distance.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

enum class VoxelRule {
  /// Keeps every voxel whose interior meets the solid: the union contains the mesh, with no unnecessary
  /// voxel. A surface within 1e-6·width of a voxel's face counts as lying in the face, not in the interior.
  cover,
  threshold,  ///< voxels with distance(centre) < threshold·width; ties within 1e-6·width are out
};

struct LatticeSettings {
  double width = 0;  ///< voxel width [m], > 0
  VoxelRule rule = VoxelRule::cover;
  double threshold = 0.5;  ///< in voxel widths; only for VoxelRule::threshold
};

/// A slab of the grid whose vertices, from the integer coordinate `first` along `axis` on to the next slab,
/// lie at rest elsewhere than in the grid, by −offset [m].
struct LatticeSlab {
  int axis = 0, first = 0;
  Vec3 offset = Vec3::Zero();
};

struct MUSLIN_API Lattice {
  Vec3 origin = Vec3::Zero();    ///< corner of voxel (0,0,0) [m]
  double width = 1;              ///< [m]
  Vec3i extent = Vec3i::Zero();  ///< voxels of the bounding grid along x, y, z

  std::vector<Vec3i> voxels;  ///< #C kept voxels
  /// #C share of the voxel that the solid fills, in [1e-3, 1]: a lower share would make springs and masses
  /// too small for any step. Exact for a closed mesh without self-overlap, else from 8³ samples.
  std::vector<double> fill;
  std::vector<std::array<int, 8>> voxel_vertices;  ///< #C corner c at offset (c&1, c>>1&1, c>>2&1) in x, y, z
  std::vector<Vec3i> vertices;                     ///< #V integer coordinates

  /// By ascending `first`, of one axis; empty: every vertex lies where it is in the grid.
  std::vector<LatticeSlab> slabs;
  double coverage = 1;  ///< share of the mesh's area that lies inside kept voxels

  std::size_t voxel_count() const { return voxels.size(); }
  std::size_t vertex_count() const { return vertices.size(); }
  Vec3 rest_position(std::size_t v) const {
    const Vec3 in_grid = origin + width * vertices[v].cast<double>();
    return slabs.empty() ? in_grid : Vec3(in_grid - offset(vertices[v]));
  }
  /// Returns the index of the voxel at these coordinates, −1 if it is not kept.
  int find_voxel(const Vec3i& coordinates) const;
  int find_vertex(const Vec3i& coordinates) const;
  /// Returns the offset of the slab of a vertex.
  Vec3 offset(const Vec3i& coordinates) const;
};

/// Builds the lattice of the solid that `mesh` encloses. The grid is centred on the mesh's bounding box,
/// with at least one voxel along every axis; a size that is a whole number of widths, up to 1e-6·width, gives
/// that many voxels. For thresholds above one half the grid is wider by the voxels that may be kept around
/// the box. Memory and time grow with the kept voxels, not with the grid. Same bits for any thread count.
/// Errors: usage, if a setting is invalid; input, if no voxel is kept or more than 2³⁰ would be.
MUSLIN_API Lattice build_lattice(const Mesh& mesh, const SignedDistance& distance,
                                 const LatticeSettings& settings, const Progress& progress = {});

}  // namespace muslin
