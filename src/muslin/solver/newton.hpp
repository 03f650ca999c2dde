// minimize is a truncated Newton method with line search. It solves the steps of implicit Euler and BDF2,
// with and without contact.
#pragma once

#include <vector>

#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/pcg_solver.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

/// Vectors kept from step to step.
struct NewtonWorkspace {
  std::vector<Vec3> x;     ///< trial point of the line search; between searches the preconditioned gradient
  std::vector<Vec3> g, s;  ///< gradient and step
  std::vector<Vec3> base;  ///< the gradient without contact
  std::vector<Vec3> d;     ///< the step as limited
  std::vector<Vec3> end;   ///< the result
  PcgSolver pcg;

  std::size_t bytes() const;
};

/// Solves H s = b at the x where `pcg` was linearised; in double where float does not suffice.
LinearReport solve_linear(const IncrementalPotential& function, ConstVectors x, ConstVectors b,
                          const LinearSettings& settings, PcgSolver& pcg, Vectors s);

/// Minimises `function` plus the guard's potential, beginning at x, and stores the minimum in x. Held
/// vertices move to their targets as far as the guard allows. `function` is built from `problem`, without the
/// guard's potential; `length` is the length of the step [s].
///
/// The initial guess continues the motion of `state` with the change of velocity of the last step, or is the
/// inertial prediction if that has a lower value, as far as the guard allows. Each iteration solves H s = −g
/// with the true Hessian by conjugate gradients, with a loose tolerance at first (Eisenstat and Walker 1996),
/// and stops at negative curvature. The guard limits the step, and a line search backtracks along it until
/// the value has decreased enough (Armijo). Where values differ by less than their rounding, the slope
/// decides instead (the approximate Wolfe condition of Hager and Zhang 2005). The lagged quantities of
/// contact are updated in each iteration.
///
/// The error after an iteration is estimated as |s| ρ / (1 − ρ), with ρ the factor by which the
/// preconditioned norm of the gradient has decreased, plus the part of s that the guard and the line search
/// removed. A step has converged when this error is within SolverSettings::error_tolerance in every part and
/// the work of the remaining imbalance is small relative to Σ m |Δx|² of the step. docs/theory/solver.md.
StepReport minimize(const StepProblem& problem, const IncrementalPotential& function,
                    const SolverSettings& settings, const State& state, double length, Vectors x,
                    NewtonWorkspace& workspace);

/// Sets held vertices exactly to their targets where only rounding separates them; returns the number of held
/// vertices that are elsewhere.
int snap_to_targets(const StepProblem& problem, Vectors x);

}  // namespace muslin
