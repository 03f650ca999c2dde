#include "muslin/solver/anderson.hpp"

#include <Eigen/Dense>

#include "muslin/solver/vector_operations.hpp"

namespace muslin {

bool AndersonMixing::mix(ConstVectors there, ConstVectors step, Vectors more) {
  const std::size_t count = there.size();
  if (!last_.empty()) {
    if (steps_.size() == depth_) {
      steps_.erase(steps_.begin());
      changes_.erase(changes_.begin());
    }
    steps_.emplace_back(count);
    changes_.emplace_back(count);
    combine(step, -1, last_step_, steps_.back());
    combine(there, -1, last_, changes_.back());
  }
  last_.assign(there.begin(), there.end());
  last_step_.assign(step.begin(), step.end());
  if (steps_.empty()) return false;

  // γ = argmin ‖step − Σ γᵢ Δstepᵢ‖, by normal equations: what they lose in accuracy a decomposition that
  // leaves out dependent directions keeps harmless.
  const auto size = static_cast<Eigen::Index>(steps_.size());
  Eigen::MatrixXd gram(size, size);
  Eigen::VectorXd right(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const std::vector<Vec3>& a = steps_[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j <= i; ++j)
      gram(i, j) = gram(j, i) = dot(a, steps_[static_cast<std::size_t>(j)]);
    right(i) = dot(a, step);
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-12);
  decomposition.compute(gram);
  const Eigen::VectorXd weights = decomposition.solve(right);
  if (!weights.allFinite()) return false;
  set_zero(more);
  for (Eigen::Index i = 0; i < size; ++i) add(-weights(i), changes_[static_cast<std::size_t>(i)], more);
  return true;
}

}  // namespace muslin
