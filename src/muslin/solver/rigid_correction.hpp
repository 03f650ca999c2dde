// Corrects momenta and energy at the end of a step, whatever its solver tolerance.
//
// Momenta. Forces within bodies and between them sum to zero, and so do their torques. The momenta at the end
// of a step are therefore exact if and only if Σ g = 0 and Σ r × g = 0, g the gradient of the incremental
// potential: six equations for each group of touching bodies, solved by its six rigid motions, which change
// no distance within it.
//
// Energy. The residual does the work gᵀ(x − x_n)/dt² in the step, which is spurious energy. Moving the group
// slightly farther or less far along its displacement makes this work zero: one equation, one unknown.
// docs/theory/solver.md.
#pragma once

#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/step_guard.hpp"
#include "muslin/solver/incremental_potential.hpp"

namespace muslin {

/// Moves every group of parts without held vertices by the rigid motion that corrects its momenta. A group
/// that touches static bodies is not rotated, and is translated only against its contacts' stiffness. g is
/// the gradient at x.
void correct_rigid_motions(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                           ConstVectors g, Vectors x);

/// Moves every group along x − from, less its rigid motion if it is free, so that the residual does no work
/// in the step. `function` includes all potentials and contact, and g is its gradient at x; x and g are
/// updated, or left unchanged if the guard or a potential does not allow the whole motion.
void correct_work(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                  ConstVectors from, Vectors g, Vectors x);

}  // namespace muslin
