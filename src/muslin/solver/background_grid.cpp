#include "muslin/solver/background_grid.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <utility>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

/// A cell or a node of a component.
struct NodePlace {
  int component;
  std::array<int, 3> index;  // slowest axis first
  auto operator<=>(const NodePlace&) const = default;
};

/// The grid of one component.
struct Frame {
  Vec3 low = Vec3::Constant(INFINITY), high = Vec3::Constant(-INFINITY);
  std::array<int, 3> cells{};         // 0: one node only
  std::array<std::size_t, 3> axes{};  // those with cells
  std::size_t axis_count = 0;
};

void sort_and_reduce(std::vector<NodePlace>& places) {
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
}
int find(const std::vector<NodePlace>& places, const NodePlace& place) {
  const auto found = std::lower_bound(places.begin(), places.end(), place);
  return found != places.end() && *found == place ? static_cast<int>(found - places.begin()) : -1;
}

void add_to(Float4* half, int block, float scale, const Block3& b) {
  Float4* const to = half + 3 * static_cast<std::ptrdiff_t>(block);
  to[0] += scale * b.x, to[1] += scale * b.y, to[2] += scale * b.z;
}

/// half += Σ w_k w_l B over the nodes of one cell.
void add_square(const GridMatrix::Table& table, int count, const float* w, const Block3& block,
                Float4* half) {
  for (int k = 0; k < count; ++k) {
    if (w[k] == 0) continue;
    add_to(half, table[at(8 * k + k)], 0.5F * w[k] * w[k], block);
    for (int l = k + 1; l < count; ++l)
      if (w[l] != 0) add_to(half, table[at(8 * k + l)], w[k] * w[l], block);
  }
}

}  // namespace

BackgroundGrid::BackgroundGrid(ConstVectors points, std::span<const int> components,
                               std::span<const double> spacings)
    : points_(points.size()) {
  std::vector<Frame> frames(spacings.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (components[p] < 0) continue;
    Frame& frame = frames[at(components[p])];
    frame.low = frame.low.cwiseMin(points[p]), frame.high = frame.high.cwiseMax(points[p]);
  }
  constexpr double rounding = 1e-6;  // of a cell
  for (std::size_t c = 0; c < frames.size(); ++c) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double extent = (frames[c].high - frames[c].low)[static_cast<int>(axis)] / spacings[c];
      if (!(extent >= 0.5)) continue;
      frames[c].cells[axis] = std::max(1, static_cast<int>(std::ceil(extent - rounding)));
      frames[c].axes[frames[c].axis_count++] = axis;
    }
  }

  // Locate each point: its fractions now, its cell once cells are numbered.
  std::vector<NodePlace> place(points.size()), cells;
  parallel_for(points.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      place[p].component = components[p];
      if (components[p] < 0) continue;
      const Frame& frame = frames[at(components[p])];
      for (std::size_t a = 0; a < frame.axis_count; ++a) {
        const std::size_t axis = frame.axes[a];
        const double s = (points[p] - frame.low)[static_cast<int>(axis)] / spacings[at(components[p])];
        const int cell = std::clamp(static_cast<int>(std::floor(s + rounding)), 0, frame.cells[axis] - 1);
        const double t = std::clamp(s - cell, 0.0, 1.0);
        place[p].index[2 - axis] = cell;
        points_[p].t[a] = static_cast<std::uint16_t>(std::lround(t * static_cast<double>(one)));
      }
    }
  });
  for (std::size_t p = 0; p < points.size(); ++p)
    if (place[p].component >= 0 && (cells.empty() || cells.back() != place[p])) cells.push_back(place[p]);
  sort_and_reduce(cells);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (place[p].component < 0) continue;
    const bool again = p > 0 && place[p - 1] == place[p];
    points_[p].cell = again ? points_[p - 1].cell : find(cells, place[p]);
  }

  // Nodes with a weight in some point.
  const auto corner = [&](const NodePlace& cell, int n) {
    NodePlace node = cell;
    const Frame& frame = frames[at(cell.component)];
    for (std::size_t a = 0; a < frame.axis_count; ++a) node.index[2 - frame.axes[a]] += n >> a & 1;
    return node;
  };
  cells_.resize(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Frame& frame = frames[at(cells[c].component)];
    cells_[c].count = 1 << frame.axis_count;
    for (std::size_t a = 0; a < frame.axis_count; ++a) cells_[c].index[a] = cells[c].index[2 - frame.axes[a]];
    for (int n = 0; n < 8; ++n) {
      NodePlace lower = cells[c];
      for (std::size_t a = 0; a < frame.axis_count; ++a) lower.index[2 - frame.axes[a]] -= n >> a & 1;
      cells_[c].lower[at(n)] = find(cells, lower);
    }
  }
  std::vector<std::uint8_t> used(cells.size());  // bit n: node n of the cell
  for (const Point& point : points_) {
    if (point.cell < 0) continue;
    float w[8];
    const Cell& cell = weights(point, w);
    for (int n = 0; n < cell.count; ++n)
      if (w[n] != 0) used[at(point.cell)] = static_cast<std::uint8_t>(used[at(point.cell)] | 1U << n);
  }
  std::vector<NodePlace> nodes;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int n = 0; n < cells_[c].count; ++n)
      if (used[c] >> n & 1) nodes.push_back(corner(cells[c], n));
  sort_and_reduce(nodes);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    int any = -1;  // substitute for nodes without weight
    for (int n = 0; n < cells_[c].count; ++n) {
      const int node = find(nodes, corner(cells[c], n));
      if (any < 0) any = node;
      cells_[c].nodes[at(n)] = node;
    }
    for (int n = 0; n < cells_[c].count; ++n)
      if (cells_[c].nodes[at(n)] < 0) cells_[c].nodes[at(n)] = any;
  }
  for (const NodePlace& node : nodes) {
    const Frame& frame = frames[at(node.component)];
    Vec3 x = 0.5 * (frame.low + frame.high);
    for (std::size_t a = 0; a < frame.axis_count; ++a) {
      const auto axis = static_cast<int>(frame.axes[a]);
      x[axis] = frame.low[axis] + spacings[at(node.component)] * node.index[at(2 - axis)];
    }
    nodes_.push_back(x);
    node_components_.push_back(node.component);
  }
}

bool BackgroundGrid::meet(Point& a, Point& b) const {
  if (a.cell < 0 || b.cell < 0) return false;
  if (a.cell == b.cell) return true;
  const Cell &first = cells_[at(a.cell)], &second = cells_[at(b.cell)];
  if (first.count != second.count) return false;
  Point p = a, q = b;
  std::size_t lower_first = 0, lower_second = 0;
  std::size_t axis = 0;
  for (int n = 1; n < first.count; n *= 2, ++axis) {
    const int apart = first.index[axis] - second.index[axis];
    if (apart == 1 && p.t[axis] == 0) {
      p.t[axis] = static_cast<std::uint16_t>(one);
      lower_first += at(n);
    } else if (apart == -1 && q.t[axis] == 0) {
      q.t[axis] = static_cast<std::uint16_t>(one);
      lower_second += at(n);
    } else if (apart != 0) {
      return false;
    }
  }
  p.cell = first.lower[lower_first], q.cell = second.lower[lower_second];
  if (p.cell < 0 || p.cell != q.cell) return false;
  a = p, b = q;
  return true;
}

GridMatrix::GridMatrix(const BackgroundGrid& grid, std::vector<std::pair<int, int>> neighbours) {
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  std::erase_if(neighbours, [](const auto& pair) { return pair.first == pair.second; });
  const auto& cells = grid.cells();
  std::vector<std::pair<int, int>> pairs;
  const auto add_pairs = [&](const BackgroundGrid::Cell& a, const BackgroundGrid::Cell& b) {
    for (int k = 0; k < a.count; ++k)
      for (int l = 0; l < b.count; ++l) pairs.emplace_back(a.nodes[at(k)], b.nodes[at(l)]);
  };
  for (const auto& cell : cells) add_pairs(cell, cell);
  for (const auto& [a, b] : neighbours) add_pairs(cells[at(a)], cells[at(b)]);
  pattern_ = std::make_shared<const BlockPattern>(std::move(pairs), grid.node_count());

  const auto make_table = [&](const BackgroundGrid::Cell& a, const BackgroundGrid::Cell& b) {
    Table table{};
    for (int k = 0; k < a.count; ++k)
      for (int l = 0; l < b.count; ++l) table[at(8 * k + l)] = pattern_->find(a.nodes[at(k)], b.nodes[at(l)]);
    tables_.push_back(table);
  };
  for (const auto& cell : cells) make_table(cell, cell);
  first_.assign(cells.size() + 1, 0);
  for (const auto& [a, b] : neighbours) {
    neighbours_.push_back({b, static_cast<int>(tables_.size())});
    make_table(cells[at(a)], cells[at(b)]);
    ++first_[at(a) + 1];
  }
  for (std::size_t c = 0; c < cells.size(); ++c) first_[c + 1] += first_[c];

  mirror_.resize(pattern_->block_count());
  for (std::size_t row = 0; row < pattern_->node_count(); ++row) {
    for (int k = pattern_->first()[row]; k < pattern_->first()[row + 1]; ++k)
      mirror_[at(k)] = pattern_->find(pattern_->columns()[at(k)], static_cast<int>(row));
  }
}

const GridMatrix::Table& GridMatrix::table(int a, int b) const {
  if (a == b) return table(a);
  const Neighbour* n = neighbours_.data() + first_[at(a)];
  while (n->cell != b) ++n;
  return tables_[at(n->table)];
}

void GridMatrix::finish(const Float4* half, BlockMatrix& to) const {
  parallel_for(mirror_.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Float4 *const a = half + 3 * k, *const b = half + 3 * at(mirror_[k]);
      Float4* const c = to.block(static_cast<int>(k));
      c[0] = a[0] + Float4{b[0][0], b[1][0], b[2][0], 0};
      c[1] = a[1] + Float4{b[0][1], b[1][1], b[2][1], 0};
      c[2] = a[2] + Float4{b[0][2], b[1][2], b[2][2], 0};
    }
  });
}

std::size_t GridMatrix::bytes() const {
  return tables_.capacity() * sizeof(Table) + (first_.capacity() + mirror_.capacity()) * sizeof(int) +
         neighbours_.capacity() * sizeof(Neighbour) + (pattern_ ? pattern_->bytes() : 0);
}

void add_weighted(const BackgroundGrid& grid, const GridMatrix& matrix, int cell, const float* w,
                  const Block3& block, Float4* half) {
  const int count = grid.cells()[at(cell)].count;
  const GridMatrix::Table& table = matrix.table(cell);
  for (int k = 0; k < count; ++k) {
    add_to(half, table[at(8 * k + k)], 0.5F * *w++, block);
    for (int l = k + 1; l < count; ++l) add_to(half, table[at(8 * k + l)], *w++, block);
  }
}

void add_block(const BackgroundGrid& grid, const GridMatrix& matrix, const BackgroundGrid::Point& point,
               const Block3& block, Float4* half) {
  if (point.cell < 0) return;
  float w[8];
  const BackgroundGrid::Cell& cell = grid.weights(point, w);
  add_square(matrix.table(point.cell), cell.count, w, block, half);
}

void add_block(const BackgroundGrid& grid, const GridMatrix& matrix, const BackgroundGrid::Point& row,
               const BackgroundGrid::Point& column, const Block3& block, Float4* half) {
  if (row.cell < 0 || column.cell < 0) return;
  float w[8], v[8];
  const BackgroundGrid::Cell &a = grid.weights(row, w), &b = grid.weights(column, v);
  const GridMatrix::Table& table = matrix.table(row.cell, column.cell);
  for (int k = 0; k < a.count; ++k) {
    if (w[k] == 0) continue;
    for (int l = 0; l < b.count; ++l)
      if (v[l] != 0) add_to(half, table[at(8 * k + l)], w[k] * v[l], block);
  }
}

RowOfBlocks::RowOfBlocks(const BackgroundGrid& grid, const GridMatrix& matrix,
                         const BackgroundGrid::Point& row, Float4* half)
    : grid_(grid), matrix_(matrix), half_(half), row_cell_(row.cell) {
  if (row_cell_ >= 0) row_count_ = grid.weights(row, weights_).count;
}

void RowOfBlocks::add(const BackgroundGrid::Point& column, const Float4* block) {
  if (row_cell_ < 0 || column.cell < 0) return;
  if (column.cell != cell_) {
    flush();
    cell_ = column.cell;
    count_ = grid_.cells()[at(cell_)].count;
    std::fill(sums_, sums_ + count_, Block3{});
  }
  float w[8];
  grid_.weights(column, w);
  for (int l = 0; l < count_; ++l)
    sums_[l].x += w[l] * block[0], sums_[l].y += w[l] * block[1], sums_[l].z += w[l] * block[2];
}

void RowOfBlocks::flush() {
  if (cell_ < 0) return;
  const GridMatrix::Table& table = matrix_.table(row_cell_, cell_);
  for (int k = 0; k < row_count_; ++k) {
    if (weights_[k] == 0) continue;
    for (int l = 0; l < count_; ++l) add_to(half_, table[at(8 * k + l)], weights_[k], sums_[l]);
  }
}

void add_coupling(const BackgroundGrid& grid, const GridMatrix& matrix, const BackgroundGrid::Point& a,
                  const BackgroundGrid::Point& b, const Block3& block, Float4* half) {
  add_block(grid, matrix, a, block, half);
  add_block(grid, matrix, b, block, half);
  add_block(grid, matrix, a, b, {-block.x, -block.y, -block.z}, half);
}

}  // namespace muslin
