#include "muslin/lattice/connect.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/lattice/rows.hpp"

namespace muslin {
namespace {

constexpr std::size_t connect_grain = 256;

/// Rows (j,k) of vertices: every voxel row touches four.
std::vector<std::pair<int, int>> vertex_rows(const RowIndex& voxels) {
  std::vector<std::pair<int, int>> rows;
  rows.reserve(4 * voxels.size());
  for (std::size_t r = 0; r < voxels.size(); ++r)
    for (int c = 0; c < 4; ++c) rows.push_back({voxels[r].j + (c & 1), voxels[r].k + (c >> 1)});
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

/// Calls visit(x) for the vertices of row (j,k), ascending.
template <class Visit>
void for_each_vertex(const RowIndex& voxels, int j, int k, const Visit& visit) {
  constexpr int none = std::numeric_limits<int>::max();
  RowCursor around[4];
  for (int c = 0; c < 4; ++c) around[c] = RowCursor(voxels, j - (c & 1), k - (c >> 1));
  for (int x = 0;;) {
    int best = none;
    for (RowCursor& row : around) {
      const int voxel = row.next(x - 1, none);
      if (voxel != none) best = std::min(best, std::max(voxel, x));
    }
    if (best == none) return;
    visit(best);
    x = best + 1;
  }
}

}  // namespace

void connect_voxels(Lattice& lattice) {
  const RowIndex voxels(lattice.voxels);
  const auto rows = vertex_rows(voxels);
  std::vector<std::int64_t> first(rows.size() + 1, 0);
  parallel_for(rows.size(), connect_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      for_each_vertex(voxels, rows[r].first, rows[r].second, [&](int) { ++first[r + 1]; });
  });
  for (std::size_t r = 0; r < rows.size(); ++r) first[r + 1] += first[r];
  if (first.back() > std::numeric_limits<int>::max())
    throw Error(ErrorKind::input, "the lattice would have more than 2^31 vertices",
                "use a larger voxel width");

  lattice.vertices.resize(first.back());
  parallel_for(rows.size(), connect_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      std::int64_t at = first[r];
      for_each_vertex(voxels, rows[r].first, rows[r].second,
                      [&](int x) { lattice.vertices[at++] = {x, rows[r].first, rows[r].second}; });
    }
  });

  lattice.voxel_vertices.resize(lattice.voxels.size());
  const RowIndex vertices(lattice.vertices);
  parallel_for(voxels.size(), connect_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const Row& row = voxels[r];
      for (int side = 0; side < 4; ++side) {
        RowCursor cursor(vertices, row.j + (side & 1), row.k + (side >> 1));
        for (int v = row.begin; v < row.end; ++v) {
          const int low = cursor.find(lattice.voxels[v].x());
          lattice.voxel_vertices[v][2 * side] = low;
          lattice.voxel_vertices[v][2 * side + 1] = low + 1;
        }
      }
    }
  });
}

}  // namespace muslin
