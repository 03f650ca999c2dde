// SpringDamping damps lattice springs in proportion to their stiffness.
#pragma once

#include <memory>

#include "muslin/energy/spring_energy.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// Axial dashpots beside the springs, c = β k: the force on b is −c n nᵀ(v_b − v_a). n is the spring's
/// direction predicted for the time the step's velocity belongs to (StepContext::velocity_time), so that free
/// fall is not damped, rigid rotation only by the prediction's error, and the dashpots are quadratic in x: W
/// = Σ β k (nᵀ(z − z_anchor))² / (2 dt).
class SpringDamping : public Load {
 public:
  /// beta [s] ≥ 0: Rayleigh's stiffness-proportional damping.
  SpringDamping(std::shared_ptr<const SpringEnergy> springs, double beta);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  std::shared_ptr<const SpringEnergy> springs_;
  double beta_;
};

}  // namespace muslin
