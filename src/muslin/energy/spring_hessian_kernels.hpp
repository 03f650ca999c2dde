// Adds springs and dashpots as couplings of the linearised Hessian.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/linearization.hpp"

namespace muslin {

/// The springs of a coupling pattern.
struct BlockSprings {
  std::shared_ptr<const EliminationOrder> pattern;
  struct Type {
    float k = 0, rest = 0;  ///< [N/m], [m]
  };
  std::vector<Type> types;         ///< by kind
  const float* weights = nullptr;  ///< of k: 16 for each block, 0 where a lane has no spring; null: all 1
};

/// Adds to `into`, for a body whose vertices are first, first + 1, …: couplings ∂²W/∂z² = s sᵀ + t I of W = ½
/// k (|z| − r)², z between the ends: s = √(k r/|z|) n and t = k (1 − r/|z|), n = z/|z|; s = 0 and t = k
/// without a direction.
void set_spring_hessian(const BlockSprings& springs, ConstVectors x, std::size_t first, Linearization& into);

/// s sᵀ += k n nᵀ, dashpots along n ∥ s: s grows to √(|s|² + k) n. Where s is zero, n is that of x.
void add_dashpot_hessian(const BlockSprings& dashpots, ConstVectors x, std::size_t first,
                         Linearization& into);

}  // namespace muslin
