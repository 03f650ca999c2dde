// BackgroundGrid interpolates values trilinearly from the nodes of a coarse grid to scattered points.
//
// Points belong to components, which share no nodes. The axes along which a component is thinner than half a
// cell have a single node; along the others every occupied cell has two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/solver/block_matrix.hpp"

namespace muslin {

class BackgroundGrid {
 public:
  /// 1, 2, 4 or 8 nodes; bit a of a node's number in the cell is set at the upper end of the a-th axis with
  /// two nodes.
  struct Cell {
    int count = 1;
    std::array<int, 8> nodes{};
    std::array<int, 3> index{};  ///< along the axes with two nodes
    std::array<int, 8> lower{};  ///< neighbour lower along the axes of the index' bits; −1: none
  };
  /// cell −1 marks an excluded point. `t` is the position in the cell along each axis with two nodes, in
  /// units of 1/32768.
  struct Point {
    int cell = -1;
    std::array<std::uint16_t, 3> t{};
  };

  BackgroundGrid() = default;
  /// `points` #P by 3; `components` #P, −1 for excluded points; `spacings` by component.
  BackgroundGrid(ConstVectors points, std::span<const int> components, std::span<const double> spacings);

  std::size_t node_count() const { return nodes_.size(); }
  const std::vector<Vec3>& nodes() const { return nodes_; }
  const std::vector<int>& node_components() const { return node_components_; }
  const std::vector<Cell>& cells() const { return cells_; }
  const Point& point(std::size_t p) const { return points_[p]; }

  /// Computes the weights of the nodes of the point's cell, which must exist; returns the cell.
  const Cell& weights(const Point& point, float (&w)[8]) const {
    const Cell& cell = cells_[static_cast<std::size_t>(point.cell)];
    w[0] = 1;
    std::size_t axis = 0;
    for (int n = 1; n < cell.count; n *= 2, ++axis) {
      const float t = static_cast<float>(point.t[axis]) * (1.0F / one);
      for (int k = 0; k < n; ++k) {
        w[n + k] = t * w[k];
        w[k] -= w[n + k];
      }
    }
    return cell;
  }

  /// If both points lie in or on the border of a common cell, expresses them in that cell and returns true.
  bool meet(Point& a, Point& b) const;

  std::size_t bytes() const {
    return points_.capacity() * sizeof(Point) + cells_.capacity() * sizeof(Cell) +
           nodes_.capacity() * sizeof(Vec3) + node_components_.capacity() * sizeof(int);
  }

 private:
  static constexpr float one = 32768;

  std::vector<Point> points_;
  std::vector<Cell> cells_;
  std::vector<Vec3> nodes_;
  std::vector<int> node_components_;
};

/// GridMatrix stores the blocks of a matrix between the nodes of a grid and their places. Only half of a
/// symmetric matrix need be added: `finish` adds its transpose.
class GridMatrix {
 public:
  GridMatrix() = default;
  /// `neighbours`: pairs of cells whose points are coupled, in any order and number; pairs of a cell with
  /// itself are implied.
  GridMatrix(const BackgroundGrid& grid, std::vector<std::pair<int, int>> neighbours);

  const std::shared_ptr<const BlockPattern>& pattern() const { return pattern_; }

  /// Blocks between the nodes of cell a (rows, eight each) and those of cell b.
  using Table = std::array<int, 64>;
  const Table& table(int a) const { return tables_[static_cast<std::size_t>(a)]; }
  const Table& table(int a, int b) const;

  /// to = half + halfᵀ
  void finish(const Float4* half, BlockMatrix& to) const;
  std::size_t bytes() const;

 private:
  struct Neighbour {
    int cell, table;
  };
  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<Table> tables_;  // of each cell with itself, then of neighbours
  std::vector<int> first_;     // by cell: its neighbours
  std::vector<Neighbour> neighbours_;
  std::vector<int> mirror_;  // by block: its transpose
};

/// A 3×3 block as BlockMatrix stores it.
struct Block3 {
  Float4 x, y, z;
};
/// half += Σ w B of nodes k ≤ l of a cell; w by k and l in the order (0,0), (0,1), …, (1,1), …
void add_weighted(const BackgroundGrid& grid, const GridMatrix& matrix, int cell, const float* w,
                  const Block3& block, Float4* half);
/// half += Pᵀ B P for a block at a point, a block between two points, or a coupling.
void add_block(const BackgroundGrid& grid, const GridMatrix& matrix, const BackgroundGrid::Point& at,
               const Block3& block, Float4* half);
void add_block(const BackgroundGrid& grid, const GridMatrix& matrix, const BackgroundGrid::Point& row,
               const BackgroundGrid::Point& column, const Block3& block, Float4* half);

/// half += Pᵀ B P of blocks between one point and several: the blocks of each cell are first summed with
/// their weights, then multiplied by those of the row.
class RowOfBlocks {
 public:
  RowOfBlocks(const BackgroundGrid& grid, const GridMatrix& matrix, const BackgroundGrid::Point& row,
              Float4* half);
  ~RowOfBlocks() { flush(); }
  RowOfBlocks(const RowOfBlocks&) = delete;
  RowOfBlocks& operator=(const RowOfBlocks&) = delete;
  /// `block`: three columns.
  void add(const BackgroundGrid::Point& column, const Float4* block);

 private:
  void flush();

  const BackgroundGrid& grid_;
  const GridMatrix& matrix_;
  Float4* half_;
  int row_cell_, cell_ = -1;
  int row_count_ = 0, count_ = 0;
  float weights_[8];
  Block3 sums_[8];
};
void add_coupling(const BackgroundGrid& grid, const GridMatrix& matrix, const BackgroundGrid::Point& a,
                  const BackgroundGrid::Point& b, const Block3& block, Float4* half);

}  // namespace muslin
