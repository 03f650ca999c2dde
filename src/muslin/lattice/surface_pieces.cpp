#include "muslin/lattice/surface_pieces.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <tbb/parallel_sort.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

/// A convex polygon: a triangle cut by planes across the axes.
struct Polygon {
  static constexpr int capacity = 16;
  std::array<Vec3, capacity> points;
  int size = 0;

  void add(const Vec3& point) {
    if (size < capacity) points[size++] = point;
  }
  double lowest(int axis) const {
    double value = points[0][axis];
    for (int p = 1; p < size; ++p) value = std::min(value, points[p][axis]);
    return value;
  }
  double highest(int axis) const {
    double value = points[0][axis];
    for (int p = 1; p < size; ++p) value = std::max(value, points[p][axis]);
    return value;
  }
};

void split(const Polygon& polygon, int axis, double at, Polygon& below, Polygon& above) {
  below.size = above.size = 0;
  for (int p = 0; p < polygon.size; ++p) {
    const Vec3& a = polygon.points[p];
    const Vec3& b = polygon.points[(p + 1) % polygon.size];
    const double da = a[axis] - at, db = b[axis] - at;
    if (da <= 0) below.add(a);
    if (da >= 0) above.add(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      Vec3 cut = a + (da / (da - db)) * (b - a);
      cut[axis] = at;
      below.add(cut);
      above.add(cut);
    }
  }
}

/// Calls visit(slab, part) for the slabs [i, i+1] that the polygon passes. The first and last slab of the
/// grid have no outer end, so that nothing is lost to rounding of the bounding box.
template <class Visit>
void for_each_slab(Polygon rest, int axis, int extent, const Visit& visit) {
  const double low = rest.lowest(axis), high = rest.highest(axis);
  const int first = std::clamp(static_cast<int>(std::floor(low)), 0, extent - 1);
  const int last = std::clamp(static_cast<int>(std::ceil(high)) - 1, first, extent - 1);
  Polygon below, above;
  for (int slab = first; slab < last; ++slab) {
    split(rest, axis, slab + 1.0, below, above);
    if (below.size >= 3) visit(slab, below);
    if (above.size < 3) return;
    std::swap(rest, above);
  }
  visit(last, rest);
}

/// Calls visit(voxel, part) for the voxels that the triangle passes.
template <class Visit>
void for_each_voxel(const Polygon& triangle, const Vec3i& extent, const Visit& visit) {
  for_each_slab(triangle, 1, extent.y(), [&](int j, const Polygon& in_j) {
    for_each_slab(in_j, 2, extent.z(), [&](int k, const Polygon& in_jk) {
      for_each_slab(in_jk, 0, extent.x(),
                    [&](int i, const Polygon& in_voxel) { visit(Vec3i(i, j, k), in_voxel); });
    });
  });
}

Polygon local_triangle(const Mesh& mesh, const Vec3i& triangle, const VoxelKeys& grid) {
  Polygon polygon;
  for (int c = 0; c < 3; ++c) polygon.add(grid.local(mesh.positions[triangle[c]]));
  return polygon;
}

bool crosses_interior(const Polygon& polygon, const Vec3i& voxel) {
  for (int axis = 0; axis < 3; ++axis) {
    if (polygon.highest(axis) <= voxel[axis] + face_tolerance) return false;
    if (polygon.lowest(axis) >= voxel[axis] + 1 - face_tolerance) return false;
  }
  return true;
}

struct Piece {
  std::uint64_t key;
  std::int32_t triangle;
  bool crossed;
  double area, moment;
};

Piece measure(const Polygon& polygon, const Vec3i& voxel, std::uint64_t key, int triangle) {
  Piece piece{key, triangle, crosses_interior(polygon, voxel), 0, 0};
  const Vec3& a = polygon.points[0];
  for (int p = 1; p + 1 < polygon.size; ++p) {
    const Vec3 &b = polygon.points[p], &c = polygon.points[p + 1];
    const double area = 0.5 * ((b.y() - a.y()) * (c.z() - a.z()) - (b.z() - a.z()) * (c.y() - a.y()));
    piece.area += area;
    piece.moment += area * ((a.x() - voxel.x()) + (b.x() - voxel.x()) + (c.x() - voxel.x())) / 3;
  }
  return piece;
}

double area_of(const Polygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (int p = 1; p + 1 < polygon.size; ++p)
    sum += (polygon.points[p] - polygon.points[0]).cross(polygon.points[p + 1] - polygon.points[0]);
  return 0.5 * sum.norm();
}

/// True if the polygon lies in one of the listed voxels or, where it lies in a face, edge or corner, in one
/// of those on its other sides.
bool covered(const Polygon& polygon, const Vec3i& voxel, const VoxelKeys& grid,
             const std::vector<std::uint64_t>& keys) {
  std::array<std::array<int, 2>, 3> candidates;
  for (int axis = 0; axis < 3; ++axis) {
    int other = voxel[axis];
    if (polygon.highest(axis) <= voxel[axis] + face_tolerance) --other;
    if (polygon.lowest(axis) >= voxel[axis] + 1 - face_tolerance) ++other;
    candidates[axis] = {voxel[axis], other};
  }
  for (int c = 0; c < 8; ++c) {
    const Vec3i candidate(candidates[0][c & 1], candidates[1][c >> 1 & 1], candidates[2][c >> 2 & 1]);
    if (grid.contains(candidate) && std::binary_search(keys.begin(), keys.end(), grid.pack(candidate)))
      return true;
  }
  return false;
}

constexpr std::size_t triangle_grain = 1024;

}  // namespace

VoxelKeys::VoxelKeys(const Vec3& origin, double width, const Vec3i& extent)
    : origin(origin),
      width(width),
      extent(extent),
      bits_x(std::bit_width(static_cast<unsigned>(extent.x()))),
      bits_z(std::bit_width(static_cast<unsigned>(extent.z()))) {}

std::vector<SurfaceVoxel> cut_surface(const Mesh& mesh, const Triangulation& triangulation,
                                      const VoxelKeys& grid, const Progress& progress) {
  const auto& triangles = triangulation.triangles;
  std::vector<Piece> pieces;
  // Batches, for progress reports and cancellation.
  const std::size_t batch = 64 * triangle_grain;
  for (std::size_t start = 0; start < triangles.size(); start += batch) {
    progress.at(0.5 * static_cast<double>(start) / static_cast<double>(triangles.size()), "lattice");
    const std::size_t count = std::min(batch, triangles.size() - start);
    std::vector<std::vector<Piece>> blocks((count + triangle_grain - 1) / triangle_grain);
    parallel_for(count, triangle_grain, [&](std::size_t begin, std::size_t end) {
      auto& block = blocks[begin / triangle_grain];
      for (std::size_t t = start + begin; t < start + end; ++t) {
        for_each_voxel(local_triangle(mesh, triangles[t], grid), grid.extent,
                       [&](const Vec3i& voxel, const Polygon& part) {
                         block.push_back(measure(part, voxel, grid.pack(voxel), static_cast<int>(t)));
                       });
      }
    });
    for (const auto& block : blocks) pieces.insert(pieces.end(), block.begin(), block.end());
  }
  progress.at(0.5, "lattice");
  tbb::parallel_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  std::vector<SurfaceVoxel> voxels;
  for (const Piece& piece : pieces) {
    if (voxels.empty() || voxels.back().key != piece.key) voxels.push_back({piece.key, false, 0, 0});
    SurfaceVoxel& voxel = voxels.back();
    voxel.crossed = voxel.crossed || piece.crossed;
    voxel.area += piece.area;
    voxel.moment += piece.moment;
  }
  return voxels;
}

double area_within(const Mesh& mesh, const Triangulation& triangulation, const VoxelKeys& grid,
                   const std::vector<std::uint64_t>& keys) {
  return parallel_sum(triangulation.triangles.size(), triangle_grain, 0.0,
                      [&](std::size_t begin, std::size_t end) {
                        double area = 0;
                        for (std::size_t t = begin; t < end; ++t) {
                          for_each_voxel(local_triangle(mesh, triangulation.triangles[t], grid), grid.extent,
                                         [&](const Vec3i& voxel, const Polygon& part) {
                                           if (covered(part, voxel, grid, keys)) area += area_of(part);
                                         });
                        }
                        return area;
                      }) *
         grid.width * grid.width;
}

}  // namespace muslin
