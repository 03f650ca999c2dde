// Predicts a rigid body at the end of a step without forces.
//
// The inertial prediction of a step moves every point in a straight line. This stretches the four points of a
// rigid body (geometry/affine_frame.hpp), which the affine body energy must undo; this loses a fraction θ² of
// the spin in a step of implicit Euler that turns the body by θ, and costs most of the solver's work. These
// points are therefore predicted by a rigid motion:
//
//   implicit Euler   Rotated by R = exp(dt ω½) about the centre, which moves in a straight line, with
//                    ω½ = J½⁻¹ L the angular velocity in the middle of the step. The anchor is chosen such
//                    that without forces the velocities at the end are those of ω₁ = (R J Rᵀ)⁻¹ L: the
//                    angular momentum L is conserved, as in Buss, Accurate and Efficient Simulation of
//                    Rigid-Body Rotations (2000).
//   BDF2             The rigid motion nearest to its prediction, which is accurate enough.
//
// docs/theory/rigid-bodies.md.
#pragma once

#include "muslin/potential/state.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

/// Changes anchor and prediction of vertices first … first + 3, of equal masses, in the context of a step
/// from `state`. Those of symplectic Euler are unchanged.
void predict_rigid(Integrator integrator, const State& state, std::size_t first, StepContext& context);

}  // namespace muslin
