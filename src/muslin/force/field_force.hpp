// FieldForce accelerates vertices by a field.
#pragma once

#include <memory>
#include <vector>

#include "muslin/force/field.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The force mᵢ a(xᵢ, t) on every vertex, a in m/s². It is read at the positions at the beginning of the step
/// and stays constant during it, so with implicit Euler the motion in a field is that of symplectic Euler:
/// bounded for steps below 2/√(∂a/∂x).
class FieldForce : public Load {
 public:
  /// masses: #V [kg], 0 where the field does not act.
  FieldForce(std::vector<double> masses, Field acceleration);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  std::vector<double> masses_;
  Field acceleration_;
};

}  // namespace muslin
