// PointForce applies forces to single vertices.
#pragma once

#include <memory>
#include <vector>

#include "muslin/force/keyed.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The force f [N] on each of the listed vertices, independent of their positions: W = −Σ wᵥ f·xᵥ. f is read
/// at the end of each step.
class PointForce : public Load {
 public:
  /// vertices: each at most once; weights: one per vertex, or none if all are 1.
  PointForce(const std::vector<int>& vertices, Keyed force, Window window,
             const std::vector<double>& weights = {});
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  struct Share {
    int vertex = 0;
    double weight = 1;
  };
  class DeadLoad;
  std::shared_ptr<const std::vector<Share>> shares_;
  Keyed force_;
  Window window_;
};

}  // namespace muslin
