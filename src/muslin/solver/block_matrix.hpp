// BlockMatrix is a symmetric matrix of 3×3 blocks between the nodes of a grid, in float. Rows are stored
// completely, for Gauss-Seidel sweeps; a block is three columns of four floats (the fourth 0), one vector
// register each.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "muslin/solver/float_vectors.hpp"

namespace muslin {

/// The blocks of the matrix: those of every pair, and the diagonal.
class BlockPattern {
 public:
  /// `pairs`: first and second node, in any order and number.
  BlockPattern(std::vector<std::pair<int, int>> pairs, std::size_t node_count);

  std::size_t node_count() const { return first_.size() - 1; }
  std::size_t block_count() const { return columns_.size(); }
  /// Row v has blocks first()[v] … first()[v+1] − 1, in ascending order of their columns.
  const std::vector<int>& first() const { return first_; }
  const std::vector<int>& columns() const { return columns_; }
  /// Returns the diagonal block of each row.
  const std::vector<int>& diagonal() const { return diagonal_; }
  /// Returns the block of row and column, which must exist.
  int find(int row, int column) const;
  std::size_t bytes() const {
    return (first_.capacity() + columns_.capacity() + diagonal_.capacity()) * sizeof(int);
  }

 private:
  std::vector<int> first_, columns_, diagonal_;
};

class BlockMatrix {
 public:
  /// Resets to a zero matrix of this pattern.
  void reset(const BlockPattern& pattern);

  /// Returns the three columns of a block.
  Float4* block(int index) { return columns_.data() + 3 * static_cast<std::size_t>(index); }
  const Float4* block(int index) const { return columns_.data() + 3 * static_cast<std::size_t>(index); }

  std::size_t bytes() const { return columns_.bytes(); }

 private:
  Buffer<Float4> columns_;
};

}  // namespace muslin
