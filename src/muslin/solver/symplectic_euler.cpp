#include "muslin/solver/symplectic_euler.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

/// y = M⁻¹ K d on free vertices, zero on held ones.
void stiffness_over_mass(const StepProblem& problem, ConstVectors x, ConstVectors d, Vectors y) {
  std::fill(y.begin(), y.end(), Vec3::Zero());
  for (const Potential* potential : problem.potentials) potential->add_hessian_product(x, d, y);
  for (std::size_t v = 0; v < y.size(); ++v) {
    y[v] = problem.fixed[v] != 0 ? Vec3(Vec3::Zero()) : Vec3(y[v] / problem.masses[v]);
  }
}

double mass_norm(const StepProblem& problem, ConstVectors d) {
  double sum = 0;
  for (std::size_t v = 0; v < d.size(); ++v) sum += problem.masses[v] * d[v].squaredNorm();
  return std::sqrt(sum);
}

/// Returns the highest angular frequency [1/s] at x, by power iteration from d.
double highest_frequency(const StepProblem& problem, ConstVectors x, std::vector<Vec3> d) {
  std::vector<Vec3> y(d.size());
  const double start = mass_norm(problem, d);
  if (!(start > 0) || !std::isfinite(start)) {
    for (std::size_t v = 0; v < d.size(); ++v) d[v] = v % 2 == 0 ? Vec3(1, 1, 1) : Vec3(-1, 1, -1);
  }
  double square = 0;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const double scale = 1 / mass_norm(problem, d);
    for (Vec3& v : d) v *= scale;
    stiffness_over_mass(problem, x, d, y);
    square = mass_norm(problem, y);
    if (!(square > 0) || !std::isfinite(square)) break;
    d.swap(y);
  }
  return std::sqrt(square);
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
  std::vector<Vec3> acceleration(count);
  stiffness_over_mass(problem, state.positions, change, acceleration);
  double curvature = 0;
  for (std::size_t v = 0; v < count; ++v) curvature += problem.masses[v] * change[v].dot(acceleration[v]);
  if (!std::isfinite(norm) || !std::isfinite(curvature) || dt * dt * curvature > 4 * norm * norm) {
    report.converged = false;
    char text[160];
    const double frequency = highest_frequency(problem, state.positions, change);
    std::snprintf(
        text, sizeof text,
        "symplectic Euler is not stable with steps of %.3g s; the largest stable step is about %.3g s", dt,
        2 / frequency);
    report.failure = text;
  }
  return report;
}

}  // namespace muslin
