// Corrections at the end of a step that make momenta and energy right however loosely it was solved.
//
// Momenta. Forces within bodies and between them sum to zero, and so do their torques. The momenta that a step
// ends with are therefore right if and only if Σ g = 0 and Σ r × g = 0, g the gradient of the incremental
// potential: six equations for each group of bodies that touch, which six rigid motions of the group solve
// while no distance within it changes.
//
// Energy. The residual does the work gᵀ(x − x_n)/dt² in the step, which is energy out of nothing. It is zero if the group goes a little more or less far along its own motion: one equation, one
// unknown. docs/theory/solver.md.
#pragma once

#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/step_guard.hpp"
#include "muslin/solver/incremental_potential.hpp"

namespace muslin {

/// Moves every group of parts that is not held by the rigid motion that its momenta lack; along what it
/// touches that does not move, and about that, it stays. g is the gradient at x.
void correct_rigid_motions(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                           ConstVectors g, Vectors x);

/// Moves every group along x − from, less its rigid motion if it is free, so far that the residual does no work
/// in the step. `function` is everything that acts, contact included, and g its gradient at x; both are brought
/// to the new x, or left as they are if the guard or a potential does not allow all of the motion.
void correct_work(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                  ConstVectors from, Vectors g, Vectors x);

}  // namespace muslin
