// Pairwise couplings of a Hessian, stored in 8 bytes each: vertices a and b share the block
//
//   B = q s sᵀ + t I,   ∂²W/∂x_a² ∋ B,  ∂²W/∂x_a∂x_b ∋ −B,
//
// as every central force has them. s is three 16-bit integers, their unit (√q) common to a piece of at most
// CouplingPattern::block_size couplings; t is a float cut to its upper 16 bits. The errors, 3e-5 of the
// largest s of the piece and 4e-3 of t, are far below what the inner solver is asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "muslin/potential/coupling_pattern.hpp"
#include "muslin/potential/float_vectors.hpp"

namespace muslin {

class Couplings {
 public:
  /// Couplings of a body whose vertices are first, first + 1, …; all zero.
  void reset(std::shared_ptr<const CouplingPattern> pattern, std::size_t first);

  const CouplingPattern& pattern() const { return *pattern_; }
  std::size_t first() const { return first_; }

  /// s scaled by √q and t of a piece.
  void load(const CouplingPiece& piece, float* sx, float* sy, float* sz, float* t) const;
  /// Stores s (with √q in it) and t; different pieces may be stored by different threads.
  void store(const CouplingPiece& piece, const float* sx, const float* sy, const float* sz, const float* t);

  /// The four arrays of a piece, one after the other, each `length` long.
  const std::uint16_t* coefficients(const CouplingPiece& piece) const {
    return coefficients_.data() + 4 * piece.slot;
  }
  float unit(int piece) const { return units_.data()[piece]; }

  /// y = diag(identity) p + Σ B (p_a − p_b) on the body's vertices; returns pᵀy. Vectors start at the body.
  double product(const float* identity, Floats p, Floats y) const;

  /// Adds the projected blocks q s sᵀ + max(t, 0) I to the diagonal blocks: xx, xy, xz, yy, yz, zz are the
  /// components of `upper` and `lower`, in this order. Vectors start at the body.
  void add_diagonal(Floats upper, Floats lower) const;

  std::size_t bytes() const { return coefficients_.bytes() + units_.bytes(); }

 private:
  std::shared_ptr<const CouplingPattern> pattern_;
  std::size_t first_ = 0;
  Buffer<std::uint16_t> coefficients_;
  Buffer<float> units_;  // √q by piece
};

}  // namespace muslin
