// The linear systems of a step in float: conjugate gradients on the linearised Hessian with lattice lines as
// preconditioner. What float cannot tell is left to the caller's next iteration in double.
#pragma once

#include "muslin/potential/linearization.hpp"
#include "muslin/solver/conjugate_gradient.hpp"
#include "muslin/solver/line_preconditioner.hpp"

namespace muslin {

class InnerSolver {
 public:
  /// Linearises at x. x stays valid for as long as `solve` is called.
  void linearize(const IncrementalPotential& function, ConstVectors x);

  /// Largest ‖diagonal block‖ / mass. Above `float_limit` masses vanish beside stiffnesses in float and
  /// `solve` must not be used.
  double stiffest() const { return h_.stiffest(); }
  static constexpr double float_limit = 3e5;

  /// Solves H s = b for the Hessian linearised last, as conjugate_gradient does. `norm` receives √(bᵀP⁻¹b).
  LinearReport solve(ConstVectors b, const LinearSettings& settings, Vectors s, double& norm);

  std::size_t bytes() const;

 private:
  Linearization h_;
  LinePreconditioner preconditioner_;
  FloatVectors x_, r_, z_, p_, q_;
};

}  // namespace muslin
