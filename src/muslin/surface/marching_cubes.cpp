#include <algorithm>
#include <cmath>

#include "muslin/core/parallel.hpp"
#include "muslin/lattice/rows.hpp"
#include "muslin/surface/marching.hpp"
#include "muslin/surface/marching_cubes_table.hpp"

namespace muslin {
namespace {

constexpr std::size_t row_grain = 64;

/// Signed distances at the lattice's vertices. Farther than a voxel width from the surface only the sign is
/// right: the distance changes by at most a width from one vertex of a row to the next, so most vertices of a
/// thick solid need no distance query.
std::vector<double> sample_vertices(const Lattice& lattice, const SignedDistance& distance) {
  std::vector<double> values(lattice.vertex_count());
  const RowIndex rows(lattice.vertices);
  const double needed = 1.01 * lattice.width;
  // Looking farther costs more than it saves: deep in a ball all of the surface is about equally near.
  const double reach = 16 * lattice.width;
  parallel_for(rows.size(), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      int known = -1;  // the last vertex that was looked up
      for (int v = rows[r].begin; v < rows[r].end; ++v) {
        if (known >= 0) {
          const int steps = lattice.vertices[v].x() - lattice.vertices[known].x();
          const double least = std::abs(values[known]) - steps * lattice.width;
          if (least > needed && distance.watertight()) {
            values[v] = std::copysign(least, values[known]);
            continue;
          }
        }
        const Vec3 position = lattice.rest_position(v);
        const double magnitude = std::min(distance.nearest(position, reach).distance, reach);
        values[v] = magnitude > 0 && distance.inside(position) ? -magnitude : magnitude;
        known = v;
      }
    }
  });
  return values;
}

/// The name of a point of a voxel: 4·vertex + axis for one on the edge that leaves the vertex along the axis,
/// 4·vertex + 3 for the vertex itself.
std::uint64_t name_of(const std::array<int, 8>& corners, CubePoint point) {
  if (point >= 12) return 4 * static_cast<std::uint64_t>(corners[point - 12]) + 3;
  const CubeEdge edge = cube_edge(point);
  return 4 * static_cast<std::uint64_t>(corners[edge.low]) + static_cast<std::uint64_t>(edge.axis);
}

void march_row(const Lattice& lattice, const RowIndex& voxels, const Row& row,
               const std::vector<char>& inside, std::vector<NamedTriangle>& out) {
  // Neighbours below and above along y, then z.
  std::array<RowCursor, 4> beside = {RowCursor(voxels, row.j - 1, row.k), RowCursor(voxels, row.j + 1, row.k),
                                     RowCursor(voxels, row.j, row.k - 1),
                                     RowCursor(voxels, row.j, row.k + 1)};
  for (int v = row.begin; v < row.end; ++v) {
    const auto& corners = lattice.voxel_vertices[v];
    int mask = 0;
    for (int c = 0; c < 8; ++c) mask |= inside[corners[c]] << c;
    if (mask == 0) continue;
    const int x = lattice.voxels[v].x();
    const CubeCase& cube = marching_cubes_table()[mask];
    const auto add = [&](const std::vector<std::array<CubePoint, 3>>& triangles, int part) {
      for (const auto& t : triangles) {
        out.push_back({{name_of(corners, t[0]), name_of(corners, t[1]), name_of(corners, t[2])},
                       std::int64_t{8} * v + part});
      }
    };
    add(cube.surface, 0);
    for (int face = 0; face < 6; ++face) {
      bool open;
      if (face == 0) {
        open = v == row.begin || lattice.voxels[v - 1].x() != x - 1;
      } else if (face == 1) {
        open = v + 1 == row.end || lattice.voxels[v + 1].x() != x + 1;
      } else {
        open = beside[face - 2].find(x) < 0;
      }
      if (open) add(cube.caps[face], 1 + face);
    }
  }
}

}  // namespace

MarchedSurface march_cubes(const Lattice& lattice, const SignedDistance& distance) {
  const std::vector<double> values = sample_vertices(lattice, distance);
  std::vector<char> inside(values.size());
  for (std::size_t v = 0; v < values.size(); ++v) inside[v] = values[v] <= inside_tolerance * lattice.width;

  const RowIndex voxels(lattice.voxels);
  std::vector<std::vector<NamedTriangle>> blocks((voxels.size() + row_grain - 1) / row_grain);
  parallel_for(voxels.size(), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      march_row(lattice, voxels, voxels[r], inside, blocks[begin / row_grain]);
  });

  MarchedSurface surface;
  const std::vector<std::uint64_t> names = number_vertices(blocks, surface.triangles);
  surface.positions.resize(names.size());
  surface.embedding.vertices.resize(names.size());
  surface.embedding.weights.resize(names.size());
  parallel_for(names.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const int low = static_cast<int>(names[n] / 4), axis = static_cast<int>(names[n] % 4);
      surface.embedding.vertices[n].fill(low);
      surface.embedding.weights[n] = {1};
      surface.positions[n] = lattice.rest_position(low);
      if (axis == 3) continue;
      const int high = lattice.find_vertex(lattice.vertices[low] + Vec3i::Unit(axis));
      const int from = inside[low] ? low : high, to = inside[low] ? high : low;
      const double t = crossing(distance, lattice.rest_position(from), lattice.rest_position(to),
                                values[from], values[to], 4, 1e-7);
      surface.embedding.vertices[n][1] = to;
      surface.embedding.vertices[n][0] = from;
      surface.embedding.weights[n][0] = 1 - t;
      surface.embedding.weights[n][1] = t;
      surface.positions[n] = (1 - t) * lattice.rest_position(from) + t * lattice.rest_position(to);
    }
  });
  return surface;
}

}  // namespace muslin
