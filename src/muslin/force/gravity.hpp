// Gravity is a uniform acceleration.
#pragma once

#include <memory>
#include <vector>

#include "muslin/force/keyed.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The force mᵢ g on every vertex, from W = −Σ mᵢ g·xᵢ: the height energy about the origin. g [m/s²] is read
/// at the end of each step.
class Gravity : public Load {
 public:
  /// masses: #V [kg], 0 where gravity does not act.
  Gravity(std::vector<double> masses, Keyed acceleration, Window window);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  std::shared_ptr<const std::vector<double>> masses_;
  Keyed acceleration_;
  Window window_;
};

}  // namespace muslin
