#include "muslin/solver/solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/solver/conjugate_gradient.hpp"
#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/newton.hpp"
#include "muslin/solver/pcg_solver.hpp"
#include "muslin/solver/preconditioner.hpp"
#include "muslin/solver/symplectic_euler.hpp"
#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

StepReport solve_implicit(const SolverSettings& settings, const StepContext& context,
                          const StepProblem& problem, const State& state, NewtonWorkspace& workspace,
                          std::vector<Vec3>& x) {
  const IncrementalPotential function(problem, context.inertial_prediction, context.dt);
  x = state.positions;
  return minimize(problem, function, settings, state, context.length, x, workspace);
}

/// Solves H s = b to a relative residual of `tolerance` in the norm of the preconditioner, whatever the
/// definiteness of H: in float, refined with products in double (iterative refinement; Higham, Accuracy and
/// Stability of Numerical Algorithms, ch. 12), and all in double where that does not converge.
LinearReport solve_exactly(const IncrementalPotential& function, ConstVectors x, ConstVectors b,
                           double tolerance, PcgSolver& pcg, Vectors s, Vectors residual) {
  constexpr double inner_tolerance = 1e-3;
  constexpr double slowest = 0.3;  // residual after a refinement over that before
  const std::size_t count = b.size();
  LinearSettings linear;
  linear.negative_curvature = NegativeCurvature::pass;
  pcg.begin_step();
  pcg.linearize(function, x);
  LinearReport report;
  if (pcg.fits_float()) {
    std::vector<Vec3> correction(count), product(count);
    std::fill(s.begin(), s.end(), Vec3::Zero());
    std::copy(b.begin(), b.end(), residual.begin());
    double first = 0;
    for (double before = INFINITY;;) {
      const double need = first > 0 ? tolerance * first / before : tolerance;
      linear.tolerance = std::max(0.5 * need, inner_tolerance);
      linear.enough = tolerance * first;
      double norm;
      const LinearReport solved = pcg.solve(residual, linear, correction, norm);
      if (first == 0) first = norm;
      report.relative_residual = first > 0 ? norm / first : 0;
      report.converged = norm <= tolerance * first;
      if (report.converged || !(norm <= slowest * before)) break;
      report.iterations += solved.iterations;
      before = norm;
      add(1, correction, s);
      function.hessian_product(x, s, product);
      for_each_vertex(count, [&](std::size_t v) { residual[v] = b[v] - product[v]; });
    }
    if (report.converged) return report;
  }
  linear.tolerance = tolerance;
  std::vector<Mat3> blocks(count);
  function.diagonal_blocks(x, blocks);
  const int wasted = report.iterations;
  report = conjugate_gradient(function, x, BlockJacobi(function, blocks), b, linear, s, residual);
  report.iterations += wasted;
  return report;
}

/// One Newton step from x_n on the exact tangent: with x_{n+1} = x_n + dt v_{n+1} it is
/// (M + dt² K) Δv = dt (f − dt K v_n), and held vertices have a known Δv (Baraff and Witkin 1998).
StepReport solve_linearly_implicit(const SolverSettings& settings, const StepContext& context,
                                   const StepProblem& given, const State& state, NewtonWorkspace& workspace,
                                   std::vector<Vec3>& x) {
  const std::size_t count = state.positions.size();
  const double dt = context.dt;
  StepProblem problem = given;
  if (problem.guard)
    problem.potentials.push_back(&problem.guard->potential(state.positions, StepGuard::Friction::anew));
  const IncrementalPotential function(problem, context.inertial_prediction, dt);
  std::vector<Vec3> coast(count), rhs(count), s(count), residual(count), g(count);
  for_each_vertex(count, [&](std::size_t v) {
    coast[v] =
        function.held(v) ? Vec3(problem.targets[v] - state.positions[v]) : Vec3(dt * state.velocities[v]);
  });
  function.gradient(state.positions, g);
  function.hessian_product(state.positions, coast, rhs);
  for_each_vertex(count, [&](std::size_t v) { rhs[v] = -g[v] - rhs[v]; });
  const LinearReport solved =
      solve_exactly(function, state.positions, rhs, settings.linear_tolerance, workspace.pcg, s, residual);
  x = state.positions;
  StepReport report;
  if (problem.guard) {
    add(1, s, coast);
    if (all_finite(coast)) problem.guard->advance(x, coast);
    report.held_back = snap_to_targets(problem, x);
  } else {
    add(1, coast, x);
    add(1, s, x);
    for (std::size_t v = 0; v < count; ++v) {
      if (function.held(v)) x[v] = problem.targets[v];
    }
  }
  const IncrementalPotential::Imbalance imbalance = function.imbalance(residual);
  report.converged = solved.converged;
  report.newton_iterations = 1;
  report.linear_iterations = solved.iterations;
  report.residual = imbalance.largest;
  report.worst_vertex = imbalance.vertex;
  if (!solved.converged) {
    report.failure = "the linear solve reached a relative residual of " +
                     std::to_string(solved.relative_residual) + " only";
  }
  return report;
}

}  // namespace

struct Stepper::Workspace {
  NewtonWorkspace newton;
};
Stepper::Stepper() : workspace_(std::make_unique<Workspace>()) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;
Stepper& Stepper::operator=(Stepper&&) noexcept = default;
std::size_t Stepper::bytes() const { return workspace_->newton.bytes(); }

StepReport solve_step(const SolverSettings& settings, const StepContext& context, const StepProblem& problem,
                      State& state) {
  return Stepper().step(settings, context, problem, state);
}

StepReport Stepper::step(const SolverSettings& settings, const StepContext& context,
                         const StepProblem& problem, State& state) {
  require(problem.masses.size() == state.positions.size(), "a step needs one mass for each vertex",
          "give #V masses");
  require(problem.fixed.size() == state.positions.size(), "a step needs one flag for each vertex",
          "give #V flags");
  require(state.velocities.size() == state.positions.size(), "a state needs one velocity for each vertex",
          "give #V velocities");
  std::vector<Vec3>& x = workspace_->newton.end;
  StepReport report;
  if (problem.guard) {
    if (settings.integrator == Integrator::symplectic_euler)
      throw Error(ErrorKind::usage, "symplectic_euler does not support contact",
                  "use implicit_euler, bdf2 or linearly_implicit_euler");
    problem.guard->begin(state.positions, problem.fixed);
  }
  switch (settings.integrator) {
    case Integrator::implicit_euler:
    case Integrator::bdf2:
      report = solve_implicit(settings, context, problem, state, workspace_->newton, x);
      break;
    case Integrator::linearly_implicit_euler:
      report = solve_linearly_implicit(settings, context, problem, state, workspace_->newton, x);
      break;
    case Integrator::symplectic_euler:
      report = solve_symplectic(context, problem, state, x);
      break;
  }
  if (report.made() && !all_finite(x)) {
    report.converged = false;
    report.failure = "positions are not finite numbers";
  }
  if (!report.made()) return report;
  if (problem.guard) problem.guard->end(x);

  // Reuses the oldest vectors for the newest.
  state.previous_velocities.resize(x.size());
  std::swap(state.velocities, state.previous_velocities);
  const bool explicit_step = settings.integrator == Integrator::symplectic_euler;
  const ConstVectors from = explicit_step ? ConstVectors(state.positions) : ConstVectors(context.anchor);
  for_each_vertex(x.size(), [&](std::size_t v) { state.velocities[v] = (x[v] - from[v]) / context.dt; });
  std::swap(state.previous_positions, state.positions);
  std::swap(state.positions, x);
  state.previous_dt = context.length;
  state.time = context.time_end;
  ++state.step;
  return report;
}

}  // namespace muslin
