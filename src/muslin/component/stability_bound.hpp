// StabilityBound bounds the time step of symplectic Euler for a component at rest.
#pragma once

#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

struct BodyStatistics;

/// Collects the stiffness K and the damping C of a component's elements at rest. Steps h are stable where h²K
/// + 2hC < 4M (docs/theory/solver.md). An element over n vertices stores ½ k (Σ aᵢ·dᵢ)² ≤ ½ k n Σ (aᵢ·dᵢ)²,
/// so K is bounded by n times its diagonal blocks.
class StabilityBound {
 public:
  /// Vertices at rest, #V by 3 [m].
  explicit StabilityBound(ConstVectors rest);

  /// Adds elements over this many vertices, with dashpots of Rayleigh's `beta` [s].
  void add(const Potential& elements, double vertices_of_element, double beta);

  /// Sets `stable_step` and `undamped_step` for these masses, #V [kg], and mass damping of `alpha` [1/s].
  void apply(std::span<const double> masses, double alpha, BodyStatistics& statistics) const;

 private:
  std::vector<Vec3> rest_;
  std::vector<Mat3> stiffness_, damping_;  ///< #V
};

}  // namespace muslin
