// Newton's method under a guard: the minimiser behind implicit Euler and BDF2 where surfaces touch.
#pragma once

#include "muslin/solver/newton.hpp"

namespace muslin {

/// Moves x, which is where the step begins, to the end of the step, in place; held vertices to their targets
/// as far as the guard lets them. `function` is made of `problem` and lacks the guard's potential.
///
/// The start is the inertial prediction, or, if that is lower, where the motion of `state` goes on with the
/// change of velocity of the last step, for `length` [s]; as far as the guard lets it. Each iteration asks
/// for the contact potential anew, solves H s = −g, has the step limited and backtracks along what is left of
/// it. The residual is that of contact and friction as they are at the x it belongs to: at its end a
/// converged step is a fixed point of what is lagged, found with Anderson's acceleration. A fast step ends
/// where the last iteration moved no vertex by more than some share of the guard's resolution and took most
/// of the gradient, after four more than its iterations at the latest, and reports what residual remains.
StepReport minimize_guarded(const StepProblem& problem, const IncrementalPotential& function,
                            const SolverSettings& settings, const State& state, double length, Vectors x,
                            NewtonWorkspace& workspace);

/// Puts held vertices exactly on their targets if nothing but rounding keeps them away; returns how many
/// others there are.
int land_held_vertices(const StepProblem& problem, Vectors x);

}  // namespace muslin
