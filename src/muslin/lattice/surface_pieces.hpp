// Cuts a triangle mesh along the faces of a voxel grid to find the voxels that the surface passes through and
// the part of each voxel inside the surface.
#pragma once

#include <cstdint>
#include <vector>

#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Voxels of a bounded grid, numbered in row_order by an integer of 62 bits at most.
struct VoxelKeys {
  Vec3 origin = Vec3::Zero();
  double width = 1;
  Vec3i extent = Vec3i::Ones();
  int bits_x = 1, bits_z = 1;

  VoxelKeys(const Vec3& origin, double width, const Vec3i& extent);
  std::uint64_t pack(const Vec3i& v) const {
    return (static_cast<std::uint64_t>(v.y()) << (bits_x + bits_z)) |
           (static_cast<std::uint64_t>(v.z()) << bits_x) | static_cast<std::uint64_t>(v.x());
  }
  Vec3i unpack(std::uint64_t key) const {
    const auto low = [](std::uint64_t value, int bits) {
      return static_cast<int>(value & ((std::uint64_t{1} << bits) - 1));
    };
    return {low(key, bits_x), static_cast<int>(key >> (bits_x + bits_z)), low(key >> bits_x, bits_z)};
  }
  bool contains(const Vec3i& v) const { return (v.array() >= 0).all() && (v.array() < extent.array()).all(); }
  /// Position in voxel widths from the origin.
  Vec3 local(const Vec3& position) const { return (position - origin) / width; }
  Vec3 centre(const Vec3i& v) const { return origin + width * (v.cast<double>() + Vec3::Constant(0.5)); }
};

/// A voxel that the surface passes through or touches. n is the outward normal; lengths are in voxel widths.
struct SurfaceVoxel {
  std::uint64_t key = 0;
  bool crossed = false;  ///< some of the surface lies in the interior, farther than 1e-6 from the faces
  double area = 0;       ///< ∫ n_x dA over the surface in the voxel
  double moment = 0;     ///< ∫ n_x (x − x₀) dA, x₀ the voxel's lower face
};

/// Returns the voxels that the triangles pass through, in ascending order of keys, each once. Surface that
/// lies in a face between two voxels is counted in one of them. Same bits for any thread count.
std::vector<SurfaceVoxel> cut_surface(const Mesh& mesh, const Triangulation& triangulation,
                                      const VoxelKeys& grid, const Progress& progress);

/// Surface this close to a voxel's face [voxel widths] counts as lying in the face.
inline constexpr double face_tolerance = 1e-6;

/// Returns the area [m²] of the mesh inside the closed voxels with ascending `keys`.
double area_within(const Mesh& mesh, const Triangulation& triangulation, const VoxelKeys& grid,
                   const std::vector<std::uint64_t>& keys);

}  // namespace muslin
