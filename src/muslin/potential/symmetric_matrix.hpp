// SymmetricMatrix has 3×3 blocks between the vertices of a mesh, in float: the Hessian of a shell for the
// inner solver. Only the upper triangle with the diagonal is stored; a product reads a block twice, in its
// own row and, transposed, in that of its column. Every row is therefore summed independently, in the same
// order for any thread count, with half the memory traffic of full rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "muslin/potential/float_vectors.hpp"

namespace muslin {

/// The blocks of the matrix: those of every pair of vertices of an element, and the diagonal.
class SymmetricPattern {
 public:
  /// `pairs`: first and second vertex, in any order and number.
  SymmetricPattern(std::vector<std::pair<int, int>> pairs, std::size_t vertex_count);

  std::size_t vertex_count() const { return first_.size() - 1; }
  std::size_t block_count() const { return columns_.size(); }
  /// Row v has blocks first()[v] … first()[v+1] − 1: the diagonal one, then those of later columns,
  /// ascending.
  const std::vector<int>& first() const { return first_; }
  const std::vector<int>& columns() const { return columns_; }
  /// Returns the block of a row and a column not before it, which must exist.
  int find(int row, int column) const;

  /// A block of an earlier row, whose column is this one.
  struct Mirrored {
    int block, row;
  };
  /// Row v has the transposes of mirrored()[first_mirrored()[v]] … [first_mirrored()[v+1] − 1].
  const std::vector<int>& first_mirrored() const { return first_mirrored_; }
  const std::vector<Mirrored>& mirrored() const { return mirrored_; }

  std::size_t bytes() const {
    return (first_.capacity() + columns_.capacity() + first_mirrored_.capacity()) * sizeof(int) +
           mirrored_.capacity() * sizeof(Mirrored);
  }

 private:
  std::vector<int> first_, columns_, first_mirrored_;
  std::vector<Mirrored> mirrored_;
};

class SymmetricMatrix {
 public:
  /// Resets to a zero matrix of this pattern for vertices first, first + 1, ….
  void reset(std::shared_ptr<const SymmetricPattern> pattern, std::size_t first);

  bool is_of(const std::shared_ptr<const SymmetricPattern>& pattern) const { return pattern_ == pattern; }
  const SymmetricPattern& pattern() const { return *pattern_; }
  const std::shared_ptr<const SymmetricPattern>& shared_pattern() const { return pattern_; }
  std::size_t first() const { return first_; }
  /// Returns the three columns of a block, of four floats each, the fourth 0.
  Float4* block(int index) { return columns_.data() + 3 * static_cast<std::size_t>(index); }
  const Float4* block(int index) const { return columns_.data() + 3 * static_cast<std::size_t>(index); }

  /// y += A p on the body's vertices, three floats and a zero each, starting at the body; returns pᵀA p.
  double add_product(const Float4* p, Float4* y) const;
  /// Adds the diagonal blocks: xx, xy, xz, yy, yz, zz are the components of `upper` and `lower`.
  void add_diagonal(Floats upper, Floats lower) const;

  std::size_t bytes() const { return columns_.bytes(); }

 private:
  std::shared_ptr<const SymmetricPattern> pattern_;
  std::size_t first_ = 0;
  Buffer<Float4> columns_;
};

}  // namespace muslin
