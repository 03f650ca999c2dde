// SymmetricMatrix stores 3×3 blocks between the vertices of a mesh, in float: the Hessian of a shell for the
// inner solver. Only the upper triangle with the diagonal is stored; a product reads a block twice, in its
// own row and, transposed, in that of its column. Every row is therefore summed independently, in the same
// order for any thread count, with half the memory traffic of full rows.
#pragma once

#include <cstddef>
#include <memory>

#include "muslin/core/buffer.hpp"
#include "muslin/potential/hessian_sink.hpp"
#include "muslin/potential/symmetric_pattern.hpp"
#include "muslin/solver/float_vectors.hpp"

namespace muslin {

class SymmetricMatrix {
 public:
  /// Resets to a matrix of this pattern for vertices first, first + 1, …: zero, or else undefined.
  void reset(std::shared_ptr<const SymmetricPattern> pattern, std::size_t first, bool zero = true);

  bool is_of(const std::shared_ptr<const SymmetricPattern>& pattern) const { return pattern_ == pattern; }
  const SymmetricPattern& pattern() const { return *pattern_; }
  const std::shared_ptr<const SymmetricPattern>& shared_pattern() const { return pattern_; }
  std::size_t first() const { return first_; }
  /// Returns the three columns of a block, of four floats each, the fourth 0.
  Float4* block(int index) { return columns_.data() + 3 * static_cast<std::size_t>(index); }
  const Float4* block(int index) const { return columns_.data() + 3 * static_cast<std::size_t>(index); }

  PairBlocks blocks() { return {columns_.data()}; }

  /// Sets the diagonal blocks so that every row sums to zero.
  void close_rows();

  /// y += A p on the body's vertices, three floats and a zero per vertex; p and y begin at the body's first
  /// vertex. Returns pᵀA p.
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
