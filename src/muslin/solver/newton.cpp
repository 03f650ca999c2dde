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
// A step that shrank the gradient to this share has hardly changed the Hessian, and another like it is enough
// where no more than a third of that is asked for.
constexpr double slightest_change = 0.03, ample = 3;

struct Point {
  Vectors x;
  IncrementalPotential::Evaluation at;
};

/// Moves `point` along s, downhill with slope gᵀs < 0, and g with it; false if no step helps: then `point`
/// stays and g is undefined. `room` is for positions to try; it becomes the old positions.
bool line_search(const IncrementalPotential& function, ConstVectors s, double slope, Point& point, Vectors g,
                 Vectors& room) {
  const double longest = std::min(1.0, 0.9 * function.max_step(point.x, s));
  const double allowance = rounding * point.at.value.magnitude;
  for (double t = longest; t > smallest_step;) {
    combine(point.x, t, s, room);
    // The first step tried is nearly always taken: its gradient is worth computing along with the value.
    bool have_gradient = t == longest;
    IncrementalPotential::Evaluation tried;
    if (have_gradient) {
      tried = function.evaluate(room, g);
    } else {
      tried.value = function.value(room);
    }
    const double change = tried.value.value - point.at.value.value;
    bool accepted = change <= armijo * t * slope;
    if (!have_gradient && (accepted || change <= allowance)) {
      tried = function.evaluate(room, g);
      have_gradient = true;
    }
    if (!accepted && change <= allowance) accepted = std::abs(dot(g, s)) <= slope_share * std::abs(slope);
    if (accepted && std::isfinite(tried.imbalance.norm)) {
      std::swap(point.x, room);
      point.at = tried;
      return true;
    }
    // The minimum of the parabola through value and slope at 0 and the value at t, kept within bounds.
    const double parabola = -0.5 * slope * t * t / (change - t * slope);
    t = std::isfinite(change) && std::isfinite(parabola) ? std::clamp(parabola, 0.1 * t, 0.5 * t) : 0.1 * t;
  }
  return false;
}

}  // namespace

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

std::size_t NewtonWorkspace::bytes() const {
  const std::size_t vectors = x.capacity() + g.capacity() + s.capacity() + end.capacity();
  return vectors * sizeof(Vec3) + inner.bytes();
}

StepReport minimize(const IncrementalPotential& function, const SolverSettings& settings,
                    const IncrementalPotential::Evaluation& start, Vectors x, NewtonWorkspace& workspace) {
  const std::size_t count = function.size();
  auto& [other, g, s, end, inner] = workspace;
  for (auto* vectors : {&other, &s}) vectors->resize(count);
  Point point{x, start};
  Vectors room = other;

  inner.begin_step();
  StepReport report;
  double forcing = loosest_forcing;
  double shrink = 1;       // of the gradient in the last step
  bool as_before = false;  // whether H is that of the last step
  double floor = 0;        // of the imbalance
  for (;;) {
    const IncrementalPotential::Imbalance imbalance = point.at.imbalance;
    report.residual = imbalance.largest;
    report.worst_vertex = imbalance.vertex;
    report.converged = imbalance.largest <= settings.tolerance;
    if (report.converged) break;
    as_before =
        !as_before && shrink <= slightest_change && ample * shrink * imbalance.largest <= settings.tolerance;
    if (!as_before) {
      inner.linearize(function, point.x);
      floor = function.rounding_floor(point.x, inner.stiffest());
    }
    if (imbalance.largest <= floor) {
      report.converged = true;
      break;
    }
    if (report.newton_iterations == settings.max_iterations) {
      report.failure = "the step is not in balance after " + std::to_string(report.newton_iterations) +
                       " Newton iterations";
      break;
    }

    LinearSettings linear;
    linear.tolerance = std::max(forcing, 0.3 * settings.tolerance / imbalance.largest);
    linear.tolerance = std::min(linear.tolerance, loosest_forcing);
    ++report.newton_iterations;
    const auto move = [&] {
      report.linear_iterations += solve_linear(function, point.x, g, linear, inner, s).iterations;
      const double slope = negate_and_dot(g, s);
      return slope < 0 && line_search(function, s, slope, point, g, room);
    };
    bool moved = move();
    if (!moved && as_before) inner.linearize(function, point.x);
    if (!moved && (as_before || inner.project())) {
      function.gradient(point.x, g);  // which a search that failed has overwritten
      as_before = false;
      moved = move();
    }
    if (!moved) {
      report.failure = "no step lowers the energy any further";
      break;
    }
    // Eisenstat and Walker's second choice with exponent 2: loose far from the solution, quadratic near it.
    shrink = point.at.imbalance.norm / imbalance.norm;
    forcing = std::clamp(0.9 * shrink * shrink, 1e-4, loosest_forcing);
  }
  if (point.x.data() != x.data()) std::copy(point.x.begin(), point.x.end(), x.begin());
  return report;
}

}  // namespace muslin
