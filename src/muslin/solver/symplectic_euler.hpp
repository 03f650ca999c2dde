// solve_symplectic is the explicit integrator.
#pragma once

#include <vector>

#include "muslin/solver/solver.hpp"

namespace muslin {

/// v_{n+1} = v_n + dt M⁻¹ f(x_n), x_{n+1} = x_n + dt v_{n+1}, into x. The step is reported as not converged
/// if it is longer than the stable step: then the curvature K + 2 C/dt along the change of velocity, which
/// the fastest growing mode soon dominates, exceeds 4/dt² (docs/theory/solver.md). The failure text names the
/// stable step.
StepReport solve_symplectic(const StepContext& context, const StepProblem& problem, const State& state,
                            std::vector<Vec3>& x);

}  // namespace muslin
