// A symmetric matrix of 3×3 blocks between the vertices of a mesh, in float: the Hessian of a shell as the
// inner solver works with it. Rows are stored whole, so that a product only reads; a block is three columns
// of four floats (the fourth 0), one vector register each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/potential/float_vectors.hpp"

namespace muslin {

/// Which blocks there are: those of every pair of vertices of an element, and the diagonal.
class BlockPattern {
 public:
  /// `pairs`: first and second vertex, in any order and number.
  BlockPattern(std::vector<std::pair<int, int>> pairs, std::size_t vertex_count);

  std::size_t vertex_count() const { return first_.size() - 1; }
  std::size_t block_count() const { return columns_.size(); }
  /// Row v has blocks first()[v] … first()[v+1] − 1, in ascending order of their columns.
  const std::vector<int>& first() const { return first_; }
  const std::vector<int>& columns() const { return columns_; }
  /// The diagonal block of each row.
  const std::vector<int>& diagonal() const { return diagonal_; }
  /// The block of row and column, which must be there.
  int find(int row, int column) const;
  std::size_t bytes() const {
    return (first_.capacity() + columns_.capacity() + diagonal_.capacity()) * sizeof(int);
  }

 private:
  std::vector<int> first_, columns_, diagonal_;
};

class BlockMatrix {
 public:
  /// A matrix of this pattern for vertices first, first + 1, …; all zero.
  void reset(std::shared_ptr<const BlockPattern> pattern, std::size_t first);

  bool is_of(const std::shared_ptr<const BlockPattern>& pattern) const { return pattern_ == pattern; }
  const BlockPattern& pattern() const { return *pattern_; }
  const std::shared_ptr<const BlockPattern>& shared_pattern() const { return pattern_; }
  std::size_t first() const { return first_; }
  /// The three columns of a block.
  Float4* block(int index) { return columns_.data() + 3 * static_cast<std::size_t>(index); }
  const Float4* block(int index) const { return columns_.data() + 3 * static_cast<std::size_t>(index); }

  /// y += A p on the body's vertices, vectors starting at the body; returns pᵀA p.
  double add_product(Floats p, Floats y) const;
  /// Adds the diagonal blocks: xx, xy, xz, yy, yz, zz are the components of `upper` and `lower`.
  void add_diagonal(Floats upper, Floats lower) const;

  std::size_t bytes() const { return columns_.bytes(); }

 private:
  std::shared_ptr<const BlockPattern> pattern_;
  std::size_t first_ = 0;
  Buffer<Float4> columns_;
};

}  // namespace muslin
