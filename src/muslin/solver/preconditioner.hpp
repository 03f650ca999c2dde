// Preconditioners are approximate inverses of the Hessian of the incremental potential.
#pragma once

#include <vector>

#include "muslin/solver/incremental_potential.hpp"

namespace muslin {

/// z = P⁻¹ r with P symmetric positive definite on the free vertices; z is zero on held ones.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  virtual void apply(ConstVectors r, Vectors z) const = 0;
};

/// The inverse of every vertex's own 3×3 block.
class BlockJacobi : public Preconditioner {
 public:
  /// `blocks` as made by IncrementalPotential::diagonal_blocks.
  BlockJacobi(const IncrementalPotential& function, std::span<const Mat3> blocks);
  void apply(ConstVectors r, Vectors z) const override;

 private:
  std::vector<Mat3> inverse_;
};

}  // namespace muslin
