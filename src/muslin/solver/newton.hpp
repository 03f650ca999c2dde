// Truncated Newton with line search: the minimiser behind implicit Euler and BDF2.
#pragma once

#include <vector>

#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/inner_solver.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

/// Vectors kept from step to step.
struct NewtonWorkspace {
  std::vector<Vec3> x;     ///< where the line search starts, or what it tries
  std::vector<Vec3> g, s;  ///< gradient and step
  std::vector<Vec3> end;   ///< room for the result
  InnerSolver inner;

  std::size_t bytes() const;
};

/// Solves H s = b at the x that `inner` was linearised at; in double where float cannot.
LinearReport solve_linear(const IncrementalPotential& function, ConstVectors x, ConstVectors b,
                          const LinearSettings& settings, InnerSolver& inner, Vectors s);

/// Minimises `function` from x, in place; held vertices of x stay. x must be finite in value. The report's
/// residual is the imbalance at the returned x. Converged: imbalance ≤ settings.tolerance, or at the level
/// that rounding of the positions alone can cause.
///
/// Each iteration solves H s = −g with the true Hessian by conjugate gradients, loosely at first (Eisenstat
/// and Walker 1996) and up to the first negative curvature, then backtracks along s until the value has
/// fallen enough (Armijo). Where values differ by less than their rounding, the slope decides instead
/// (the approximate Wolfe condition of Hager and Zhang 2005).
/// `start` is what `function` evaluates to at x, with the gradient in workspace.g.
StepReport minimize(const IncrementalPotential& function, const SolverSettings& settings,
                    const IncrementalPotential::Evaluation& start, Vectors x, NewtonWorkspace& workspace);

}  // namespace muslin
