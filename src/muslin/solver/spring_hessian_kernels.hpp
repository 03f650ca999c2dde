// Computes the couplings of springs and dashpots.
#pragma once

#include <span>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/spring_network.hpp"
#include "muslin/solver/spring_hessian.hpp"

namespace muslin {

/// The springs of a coupling pattern.
struct BlockSprings {
  std::span<const CentralSpring> kinds;
  /// Factors of k: 16 for each block, 0 where a lane has no spring; null: all 1.
  const float* weights = nullptr;
  /// The body's vertices.
  ConstVectors x;
  /// Room for 6 × positions of the pattern.
  std::span<float> workspace;
};

/// Sets couplings ∂²W/∂z² = s sᵀ + t I of W = ½ k (|z| − r)², z between the ends: s = √(k r/|z|) n and t = k
/// (1 − r/|z|), n = z/|z|; s = 0 and t = k if the spring has no direction.
void set_spring_hessian(const BlockSprings& springs, SpringHessian& couplings);

/// s sᵀ += k n nᵀ for dashpots along n ∥ s: s becomes √(|s|² + k) n. Where s is zero, n is the direction at
/// x.
void add_dashpot_hessian(const BlockSprings& dashpots, SpringHessian& couplings);

}  // namespace muslin
