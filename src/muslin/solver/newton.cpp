#include "muslin/solver/newton.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "muslin/solver/conjugate_gradient.hpp"
#include "muslin/solver/preconditioner.hpp"
#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

constexpr double armijo = 1e-4;
constexpr double slope_share = 0.9;  // approximate Wolfe: the slope must have risen above −0.9 of the first
constexpr double rounding = 1e-12;   // values closer than this (relative) cannot be told apart reliably
constexpr double smallest_step = 1e-10;
constexpr double loosest_forcing = 0.1;

using Point = NewtonWorkspace::Point;

/// Moves `point` along s, downhill with slope gᵀs < 0; false if no step helps.
bool line_search(const IncrementalPotential& function, ConstVectors s, double slope, Point& point,
                 Point& trial) {
  double t = std::min(1.0, 0.9 * function.max_step(point.x, s));
  const double allowance = rounding * point.value.magnitude;
  while (t > smallest_step) {
    combine(point.x, t, s, trial.x);
    trial.value = function.value(trial.x);
    const double change = trial.value.value - point.value.value;
    bool accepted = change <= armijo * t * slope;
    const bool have_gradient = accepted || change <= allowance;
    if (have_gradient) function.gradient(trial.x, trial.g);
    if (!accepted && have_gradient) accepted = std::abs(dot(trial.g, s)) <= slope_share * std::abs(slope);
    if (accepted && all_finite(trial.g)) {
      std::swap(point, trial);
      return true;
    }
    // The minimum of the parabola through value and slope at 0 and the value at t, kept within bounds.
    const double parabola = -0.5 * slope * t * t / (change - t * slope);
    t = std::isfinite(change) && std::isfinite(parabola) ? std::clamp(parabola, 0.1 * t, 0.5 * t) : 0.1 * t;
  }
  return false;
}

/// Solves H s = b at the x that `inner` was linearised at; in double where float cannot.
LinearReport solve_linear(const IncrementalPotential& function, ConstVectors x, ConstVectors b,
                          const LinearSettings& settings, InnerSolver& inner, Vectors s) {
  if (inner.stiffest() <= InnerSolver::float_limit) {
    double norm;
    return inner.solve(b, settings, s, norm);
  }
  std::vector<Mat3> blocks(b.size());
  std::vector<Vec3> residual(b.size());
  function.diagonal_blocks(x, blocks);
  return conjugate_gradient(function, x, BlockJacobi(function, blocks), b, settings, s, residual);
}

}  // namespace

std::size_t NewtonWorkspace::bytes() const {
  const std::size_t vectors = point.x.capacity() + point.g.capacity() + trial.x.capacity() +
                              trial.g.capacity() + s.capacity() + minus_g.capacity();
  return vectors * sizeof(Vec3) + inner.bytes();
}

StepReport minimize(const IncrementalPotential& function, const SolverSettings& settings, Vectors x,
                    NewtonWorkspace& workspace) {
  const std::size_t count = function.size();
  auto& [point, trial, s, minus_g, inner] = workspace;
  point.x.assign(x.begin(), x.end());
  for (auto* vectors : {&point.g, &trial.x, &trial.g, &s, &minus_g}) vectors->resize(count);
  point.value = function.value(point.x);
  function.gradient(point.x, point.g);

  StepReport report;
  double forcing = loosest_forcing;
  for (;;) {
    const IncrementalPotential::Imbalance imbalance = function.imbalance(point.g);
    report.residual = imbalance.largest;
    report.worst_vertex = imbalance.vertex;
    report.converged = imbalance.largest <= settings.tolerance;
    if (report.converged) break;
    inner.linearize(function, point.x);
    if (imbalance.largest <= function.rounding_floor(point.x, inner.stiffest())) {
      report.converged = true;
      break;
    }
    if (report.newton_iterations == settings.max_iterations) {
      report.failure = "the step is not in balance after " + std::to_string(report.newton_iterations) +
                       " Newton iterations";
      break;
    }

    for (std::size_t v = 0; v < count; ++v) minus_g[v] = -point.g[v];
    const double g_norm = std::sqrt(dot(point.g, point.g));
    LinearSettings linear;
    linear.tolerance = std::max(forcing, 0.3 * settings.tolerance / imbalance.largest);
    linear.tolerance = std::min(linear.tolerance, loosest_forcing);
    const LinearReport solved = solve_linear(function, point.x, minus_g, linear, inner, s);
    ++report.newton_iterations;
    report.linear_iterations += solved.iterations;

    const double slope = dot(point.g, s);
    if (!(slope < 0) || !line_search(function, s, slope, point, trial)) {
      report.failure = "no step lowers the energy any further";
      break;
    }
    // Eisenstat and Walker's second choice with exponent 2: loose far from the solution, quadratic near it.
    const double shrink = std::sqrt(dot(point.g, point.g)) / g_norm;
    forcing = std::clamp(0.9 * shrink * shrink, 1e-4, loosest_forcing);
  }
  std::copy(point.x.begin(), point.x.end(), x.begin());
  return report;
}

}  // namespace muslin
