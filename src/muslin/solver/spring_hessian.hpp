// SpringHessian stores the pairwise couplings of a Hessian in 8 bytes each: vertices a and b share the block
//
//   B = q s sᵀ + t I,   ∂²W/∂x_a² ∋ B,  ∂²W/∂x_a∂x_b ∋ −B,
//
// as for every central force. s is stored as three 16-bit integers whose unit √q is common to a block of 16
// couplings, t as a float truncated to its upper 16 bits. The errors, 3e-5 of the largest s of the block and
// 4e-3 of t, are far below the tolerance of the inner solver.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "muslin/core/buffer.hpp"
#include "muslin/solver/elimination_order.hpp"

namespace muslin {

class SpringHessian {
 public:
  static constexpr int lanes = EliminationOrder::lanes;

  /// Makes a zero Hessian of a body whose vertices are first, first + 1, ….
  SpringHessian(std::shared_ptr<const EliminationOrder> pattern, std::size_t first);
  void clear();

  const EliminationOrder& pattern() const { return *pattern_; }
  const std::shared_ptr<const EliminationOrder>& shared_pattern() const { return pattern_; }
  std::size_t first() const { return first_; }

  /// Load and store s (including √q) and t of `count` consecutive blocks, 16 numbers each; zero where a lane
  /// has no coupling. Different blocks may be stored by different threads.
  void load(std::size_t block, std::size_t count, float* sx, float* sy, float* sz, float* t) const;
  void store(std::size_t block, std::size_t count, const float* sx, const float* sy, const float* sz,
             const float* t);

  /// Removes the negative eigenvalues, which are t in the directions perpendicular to s.
  void project();

  /// Two words for each lane of a block, 16 first ones and then 16 second ones: the integers sx and sy in the
  /// lower and the upper half, then sz and t. Reading up to 15 words before or after is allowed.
  const std::uint32_t* coefficients() const { return coefficients_.data() + room; }
  /// The unit √q by block for integers read from the upper halves of words: 2⁻¹⁶ times the unit of sx, sy and
  /// sz.
  const float* units() const { return units_.data(); }

  /// Writable words of a block; different blocks may be written by different threads.
  std::uint32_t* words(std::size_t block) { return coefficients_.data() + room + 2 * lanes * block; }
  float* units(std::size_t block) { return units_.data() + block; }

  std::size_t bytes() const { return coefficients_.bytes() + units_.bytes(); }

 private:
  static constexpr std::size_t room = 32;

  std::shared_ptr<const EliminationOrder> pattern_;
  std::size_t first_ = 0;
  Buffer<std::uint32_t> coefficients_;
  Buffer<float> units_;
};

}  // namespace muslin
