#include "muslin/solver/symplectic_euler.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

/// Squares of smaller numbers lose digits to underflow.
constexpr double resolved = 1e-140;

/// y = M⁻¹ (K + 2 C/dt) d on free vertices, zero on held ones: the step is stable while the eigenvalues of
/// this matrix are below 4/dt². The Hessian of a damping is C/dt.
void stability_product(const StepProblem& problem, ConstVectors x, ConstVectors d, Vectors y) {
  std::fill(y.begin(), y.end(), Vec3::Zero());
  for (const Potential* potential : problem.potentials) potential->add_hessian_product(x, d, y);
  for (const Potential* damping : problem.dampings) damping->add_hessian_product(x, d, y);
  for (std::size_t v = 0; v < y.size(); ++v) {
    y[v] = problem.fixed[v] != 0 ? Vec3(Vec3::Zero()) : Vec3(y[v] / problem.masses[v]);
  }
}

double mass_product(const StepProblem& problem, ConstVectors a, ConstVectors b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += problem.masses[v] * a[v].dot(b[v]);
  return sum;
}

double mass_norm(const StepProblem& problem, ConstVectors d) {
  return std::sqrt(mass_product(problem, d, d));
}

/// Returns the largest stable step [s] of the mode that grows fastest with steps of dt, by power iteration
/// from d.
double stable_step(const StepProblem& problem, double dt, ConstVectors x, std::vector<Vec3> d) {
  std::vector<Vec3> y(d.size());
  const double start = mass_norm(problem, d);
  if (!(start > 0) || !std::isfinite(start)) {
    for (std::size_t v = 0; v < d.size(); ++v) d[v] = v % 2 == 0 ? Vec3(1, 1, 1) : Vec3(-1, 1, -1);
  }
  double curvature = 0;  // k + 2 c/dt of the mode, with stiffness k and damping c over its mass
  for (int iteration = 0; iteration < 50; ++iteration) {
    const double scale = 1 / mass_norm(problem, d);
    for (Vec3& v : d) v *= scale;
    stability_product(problem, x, d, y);
    curvature = mass_norm(problem, y);
    if (!(curvature > 0) || !std::isfinite(curvature)) break;
    d.swap(y);
  }
  y.assign(d.size(), Vec3::Zero());
  for (const Potential* damping : problem.dampings) damping->add_hessian_product(x, d, y);
  double damping = 0;
  for (std::size_t v = 0; v < d.size(); ++v)
    if (problem.fixed[v] == 0) damping += dt * d[v].dot(y[v]);
  damping /= mass_product(problem, d, d);
  const double stiffness = std::max(0.0, curvature - 2 * damping / dt);
  return 4 / (damping + std::sqrt(damping * damping + 4 * stiffness));
}

}  // namespace

StepReport solve_symplectic(const StepContext& context, const StepProblem& problem, const State& state,
                            std::vector<Vec3>& x) {
  const std::size_t count = state.positions.size();
  const double dt = context.dt;
  std::vector<Vec3> change(count, Vec3::Zero());
  for (const Potential* potential : problem.potentials) potential->add_gradient(state.positions, change);
  x = state.positions;
  for (std::size_t v = 0; v < count; ++v) {
    if (problem.fixed[v] != 0) {
      change[v].setZero();
      x[v] = problem.targets[v];
    } else {
      change[v] *= -dt / problem.masses[v];
      x[v] += dt * (state.velocities[v] + change[v]);
    }
  }
  StepReport report;
  report.converged = true;
  const double norm = mass_norm(problem, change);
  std::vector<Vec3> product(count);
  stability_product(problem, state.positions, change, product);
  const double curvature = mass_product(problem, change, product);
  const bool grows = norm > resolved && dt * dt * curvature > 4 * norm * norm;
  if (!std::isfinite(norm) || !std::isfinite(curvature) || grows) {
    report.converged = false;
    char text[160];
    std::snprintf(
        text, sizeof text,
        "symplectic Euler is not stable with steps of %.3g s; the largest stable step is about %.3g s", dt,
        stable_step(problem, dt, state.positions, change));
    report.failure = text;
  }
  return report;
}

}  // namespace muslin
