// Truncated Newton with line search: the minimiser behind implicit Euler and BDF2, with and without contact.
#pragma once

#include <vector>

#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/pcg_solver.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

/// Vectors kept from step to step.
struct NewtonWorkspace {
  std::vector<Vec3> x;     ///< what the line search tries; between searches the preconditioned gradient
  std::vector<Vec3> g, s;  ///< gradient and step
  std::vector<Vec3> base;  ///< the gradient without contact
  std::vector<Vec3> d;     ///< what of the step is left
  std::vector<Vec3> end;   ///< room for the result
  PcgSolver pcg;

  std::size_t bytes() const;
};

/// Solves H s = b at the x that `pcg` was linearised at; in double where float cannot.
LinearReport solve_linear(const IncrementalPotential& function, ConstVectors x, ConstVectors b,
                          const LinearSettings& settings, PcgSolver& pcg, Vectors s);

/// Moves x, where the step begins, to the minimum of `function` plus the guard's potential, in place; held
/// vertices to their targets as far as the guard lets them. `function` is made of `problem` and lacks the
/// guard's potential; `length` is that of the step [s].
///
/// The start is where the motion of `state` goes on with the change of velocity of the last step, or the
/// inertial prediction if that is lower, as far as the guard lets it. Each iteration solves H s = −g with the
/// true Hessian by conjugate gradients, loosely at first (Eisenstat and Walker 1996) and up to the first
/// negative curvature, has the guard limit the step and backtracks along what is left until the value has
/// fallen enough (Armijo). Where values differ by less than their rounding, the slope decides instead (the
/// approximate Wolfe condition of Hager and Zhang 2005). What contact lags is taken anew in each iteration.
///
/// The error after an iteration is estimated as |s| ρ / (1 − ρ), ρ the factor by which the preconditioned
/// norm of the gradient has fallen, plus what the guard and the line search have taken from s. A step is
/// converged when that is within SolverSettings::error_tolerance in every part, and the work of what is left
/// out of balance is a small share of what moves. docs/theory/solver.md.
StepReport minimize(const StepProblem& problem, const IncrementalPotential& function,
                    const SolverSettings& settings, const State& state, double length, Vectors x,
                    NewtonWorkspace& workspace);

/// Puts held vertices exactly on their targets if nothing but rounding keeps them away; returns how many
/// others there are.
int snap_to_targets(const StepProblem& problem, Vectors x);

}  // namespace muslin
