// Computes the step context, in which the implicit integrators differ.
//
// With w_n = (x_n, v_n) both implicit Euler and BDF2 (variable steps, ω = h_n / h_{n−1}) read
//
//   w_{n+1} = a w_n − b w_{n−1} + τ w'_{n+1}
//
//   implicit Euler   a = 1, b = 0, τ = h
//   BDF2             a = (1+ω)²/(1+2ω), b = ω²/(1+2ω), τ = h (1+ω)/(1+2ω)
//
// (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, III.5). The anchor is a x_n − b
// x_{n−1}, and the end of the step minimises the incremental potential with step τ about the inertial
// prediction anchor + τ (a v_n − b v_{n−1}).
#include "muslin/solver/solver.hpp"
#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

struct Coefficients {
  double a = 1;
  double b = 0;
  double tau = 0;
};

/// BDF2 starts with a step of implicit Euler, and restarts so where a step is more than twice as long as the
/// one before (it is stable up to 1 + √2).
Coefficients coefficients(Integrator integrator, const State& state, double dt) {
  constexpr double rounding = 1e-9;
  if (integrator != Integrator::bdf2 || state.previous_positions.empty() ||
      dt > (2 + rounding) * state.previous_dt) {
    return {1, 0, dt};
  }
  const double ratio = dt / state.previous_dt;
  const double scale = 1 / (1 + 2 * ratio);
  return {(1 + ratio) * (1 + ratio) * scale, ratio * ratio * scale, dt * (1 + ratio) * scale};
}

}  // namespace

StepContext step_context(Integrator integrator, const State& state, double dt) {
  const auto [a, b, tau] = coefficients(integrator, state, dt);
  StepContext context;
  context.time_begin = state.time;
  context.time_end = state.time + dt;
  context.dt = tau;
  context.length = dt;
  context.positions = state.positions;
  context.velocities = state.velocities;
  context.history = &state.history;
  context.velocity_time = state.time + dt / 2;
  context.anchor = state.positions;
  if (b != 0) {
    context.velocity_time = state.time + dt;
    for (std::size_t v = 0; v < context.anchor.size(); ++v) {
      context.anchor[v] = a * state.positions[v] - b * state.previous_positions[v];
    }
  }
  context.inertial_prediction.resize(context.anchor.size());
  combine(context.anchor, tau * a, state.velocities, context.inertial_prediction);
  if (b != 0) add(-tau * b, state.previous_velocities, context.inertial_prediction);
  if (integrator == Integrator::symplectic_euler) {
    context.velocity_time = state.time;
    add(-dt, state.velocities, context.anchor);
  }
  return context;
}

}  // namespace muslin
