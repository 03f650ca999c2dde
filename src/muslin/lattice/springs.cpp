#include "muslin/lattice/springs.hpp"

#include <algorithm>

#include "muslin/core/parallel.hpp"
#include "muslin/lattice/rows.hpp"

namespace muslin {
namespace {

/// The springs of one direction that start in a block of vertex rows.
struct Block {
  std::vector<SpringRun> runs;
  std::vector<float> share, mean_fill;
};

/// The voxels that contain both ends of a spring, as offsets of their lower corner from the spring's first
/// end: an axis along which the spring does not extend has a voxel on either side.
struct Around {
  std::vector<std::pair<int, int>> rows;  ///< offsets (j,k)
  int first_x = 0, last_x = 0;

  explicit Around(const Vec3i& offset) {
    const auto range = [](int d) { return std::pair<int, int>(d == 1 ? 0 : -1, d == -1 ? -1 : 0); };
    const auto y = range(offset.y()), z = range(offset.z()), x = range(offset.x());
    for (int j = y.first; j <= y.second; ++j)
      for (int k = z.first; k <= z.second; ++k) rows.push_back({j, k});
    first_x = x.first;
    last_x = x.second;
  }
  int count() const { return static_cast<int>(rows.size()) * (last_x - first_x + 1); }
};

void springs_of_row(const Lattice& lattice, const RowIndex& voxels, const RowIndex& vertices, const Row& row,
                    int direction, const Vec3i& offset, const Around& around, Block& block) {
  std::array<RowCursor, 8> cursors;
  int cursor_count = 0;
  for (const auto& [j, k] : around.rows)
    for (int x = around.first_x; x <= around.last_x; ++x)
      cursors[cursor_count++] = RowCursor(voxels, row.j + j, row.k + k);
  RowCursor ends(vertices, row.j + offset.y(), row.k + offset.z());

  const double full = around.count();
  bool open = false;  // the last run may grow
  for (int a = row.begin; a < row.end; ++a) {
    const int x = lattice.vertices[a].x();
    double fill = 0;
    int count = 0, c = 0;
    for (std::size_t r = 0; r < around.rows.size(); ++r) {
      for (int dx = around.first_x; dx <= around.last_x; ++dx) {
        const int voxel = cursors[c++].find(x + dx);
        if (voxel < 0) continue;
        fill += lattice.fill[voxel];
        ++count;
      }
    }
    if (count == 0) {
      open = false;
      continue;
    }
    block.share.push_back(static_cast<float>(fill / full));
    block.mean_fill.push_back(static_cast<float>(fill / count));
    if (open && lattice.vertices[a - 1].x() + 1 == x) {
      ++block.runs.back().length;
    } else {
      block.runs.push_back({direction, a, ends.find(x + offset.x()), 1, 0});
      open = true;
    }
  }
}

}  // namespace

std::vector<SpringDirection> spring_directions(Bracing bracing) {
  using enum SpringKind;
  std::vector<SpringDirection> directions = {{{1, 0, 0}, edge},          {{0, 1, 0}, edge},
                                             {{0, 0, 1}, edge},          {{1, 1, 0}, face_diagonal},
                                             {{1, 0, 1}, face_diagonal}, {{0, 1, 1}, face_diagonal},
                                             {{1, 1, 1}, body_diagonal}};
  if (bracing == Bracing::full) {
    directions.insert(directions.end(), {{{1, -1, 0}, face_diagonal},
                                         {{1, 0, -1}, face_diagonal},
                                         {{0, 1, -1}, face_diagonal},
                                         {{1, 1, -1}, body_diagonal},
                                         {{1, -1, 1}, body_diagonal},
                                         {{1, -1, -1}, body_diagonal}});
  }
  return directions;
}

Springs build_springs(const Lattice& lattice, Bracing bracing) {
  Springs springs;
  springs.bracing = bracing;
  springs.directions = spring_directions(bracing);
  const RowIndex voxels(lattice.voxels), vertices(lattice.vertices);

  constexpr std::size_t grain = 256;
  const std::size_t blocks_per_direction = (vertices.size() + grain - 1) / grain;
  std::vector<Block> blocks(springs.directions.size() * blocks_per_direction);
  for (std::size_t d = 0; d < springs.directions.size(); ++d) {
    const Vec3i offset = springs.directions[d].offset;
    const Around around(offset);
    parallel_for(vertices.size(), grain, [&](std::size_t begin, std::size_t end) {
      Block& block = blocks[d * blocks_per_direction + begin / grain];
      for (std::size_t r = begin; r < end; ++r)
        springs_of_row(lattice, voxels, vertices, vertices[r], static_cast<int>(d), offset, around, block);
    });
  }

  std::size_t count = 0, runs = 0;
  for (const Block& block : blocks) count += block.share.size(), runs += block.runs.size();
  springs.share.reserve(count);
  springs.mean_fill.reserve(count);
  springs.runs.reserve(runs);
  for (Block& block : blocks) {
    for (SpringRun run : block.runs) {
      run.first = springs.count;
      springs.count += run.length;
      springs.count_by_kind[static_cast<std::size_t>(springs.directions[run.direction].kind)] += run.length;
      springs.runs.push_back(run);
    }
    springs.share.insert(springs.share.end(), block.share.begin(), block.share.end());
    springs.mean_fill.insert(springs.mean_fill.end(), block.mean_fill.begin(), block.mean_fill.end());
    block = {};
  }
  return springs;
}

std::vector<std::array<int, 4>> build_tetrahedra(const Lattice& lattice) {
  // A path from corner 0 to corner 7 along the axes in some order; odd orders need two corners swapped to
  // be positively oriented. Corners are numbered as bits x, y, z.
  constexpr std::array<std::array<int, 4>, 6> split = {
      {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}}};
  std::vector<std::array<int, 4>> tetrahedra(6 * lattice.voxel_count());
  parallel_for(lattice.voxel_count(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto& corners = lattice.voxel_vertices[v];
      for (std::size_t t = 0; t < split.size(); ++t)
        for (std::size_t c = 0; c < 4; ++c) tetrahedra[6 * v + t][c] = corners[split[t][c]];
    }
  });
  return tetrahedra;
}

}  // namespace muslin
