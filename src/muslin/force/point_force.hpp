// Forces on single vertices.
#pragma once

#include <memory>
#include <vector>

#include "muslin/force/keyed.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The force f [N] on each of the listed vertices, wherever they go: W = −Σ f·xᵥ. f is read at the end of
/// each step.
class PointForce : public Load {
 public:
  /// vertices: each at most once.
  PointForce(std::vector<int> vertices, Keyed force, Window window);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  std::shared_ptr<const std::vector<int>> vertices_;
  Keyed force_;
  Window window_;
};

}  // namespace muslin
