// FullCouplings stores couplings that are not central forces, such as those of tetrahedra, in 24 bytes each:
// a 3×3 matrix B with
//
//   ∂²W/∂x_later ∂x_earlier ∋ −B,   ∂²W/∂x_later² and ∂²W/∂x_earlier² ∋ ½ (B + Bᵀ),
//
// in an elimination order. Its nine entries are integers of 21 bits with a common unit for a block of 16
// couplings: the errors are 5e-7 of the largest entry of the block. Diagonal blocks are sums of what is
// stored, so that only masses resist translations, up to the errors of B − Bᵀ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "muslin/core/buffer.hpp"
#include "muslin/solver/elimination_order.hpp"
#include "muslin/solver/symmetric_matrix.hpp"

namespace muslin {

class FullCouplings {
 public:
  static constexpr int lanes = EliminationOrder::lanes;
  static constexpr int words = 6;  ///< of a coupling

  /// Stores the off-diagonal blocks of `matrix`; the diagonal ones are not read. `slots`: for each coupling,
  /// 16 per block of couplings, the block of the matrix if the later end is its row, ~block if the later end
  /// is its column, `none` where there is no coupling.
  static constexpr int none = std::numeric_limits<int>::min();
  void set(const SymmetricMatrix& matrix, std::span<const int> slots);

  /// Computes the entries of a block's couplings, row by row, 16 each.
  void load(std::size_t block, std::span<float, 9 * lanes> entries) const;

  /// Words of a block: 16 for the first word of each coupling, then 16 for the second, …. Entries 0 to 5 are
  /// words 0 to 5, lower bits included. The lower 11 bits of words 0 and 1 contain entry 6, those of words 2
  /// and 3 entry 7, those of words 4 and 5 entry 8: 11 bits and 10. Reading up to 15 words before or after is
  /// allowed.
  const std::uint32_t* coefficients() const { return coefficients_.data() + room; }
  /// Units of the integers by block, over 2¹¹.
  const float* units() const { return units_.data(); }

  std::size_t bytes() const { return coefficients_.bytes() + units_.bytes(); }

 private:
  static constexpr std::size_t room = 32;

  Buffer<std::uint32_t> coefficients_;
  Buffer<float> units_;
};

}  // namespace muslin
