// MassDamping is Rayleigh's mass-proportional damping.
#pragma once

#include <memory>
#include <vector>

#include "muslin/potential/potential.hpp"

namespace muslin {

/// The force −α mᵢ vᵢ on every vertex: with v = (x − anchor) / dt at the end of the step it comes from
/// W = Σ α mᵢ |xᵢ − anchorᵢ|² / (2 dt).
class MassDamping : public Load {
 public:
  /// alpha [1/s] ≥ 0; masses #V [kg].
  MassDamping(double alpha, std::vector<double> masses);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  double alpha_;
  std::vector<double> masses_;
};

}  // namespace muslin
