#include "muslin/potential/mass_damping.hpp"

#include <utility>

#include "muslin/potential/anchor_springs.hpp"

namespace muslin {

MassDamping::MassDamping(double alpha, std::vector<double> masses)
    : alpha_(alpha), masses_(std::move(masses)) {}

std::unique_ptr<Potential> MassDamping::potential(const StepContext& step) const {
  if (alpha_ == 0) return nullptr;
  const double factor = alpha_ / step.dt;
  std::vector<double> coefficients = masses_;
  for (double& c : coefficients) c *= factor;
  return std::make_unique<AnchorSprings>(std::move(coefficients), step.anchor);
}

}  // namespace muslin
