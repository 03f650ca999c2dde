#include "problems.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace muslin::bench {
namespace {

constexpr std::array<double, 3> moduli = {20000, 100, 100};  // [N/m²]
constexpr double density = 10;                               // [kg/m³]

/// Waves of 6 to 30 voxels in random directions; each strains the lattice by a few per cent.
void crumple(const Lattice& lattice, std::vector<Vec3>& x) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  for (int wave = 0; wave < 40; ++wave) {
    const double length = uniform(6, 30) * lattice.width;
    const double angle = uniform(0, 2 * std::numbers::pi), phase = uniform(0, 2 * std::numbers::pi);
    const Vec3 k = 2 * std::numbers::pi / length * Vec3(std::cos(angle), std::sin(angle), 0);
    const Vec3 amplitude = 0.006 * length * Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-4, 4));
    for (std::size_t v = 0; v < x.size(); ++v)
      x[v] += std::sin(k.dot(lattice.rest_position(v)) + phase) * amplitude;
  }
}

}  // namespace

TextbookProblem Problem::textbook() const {
  TextbookProblem problem;
  problem.masses = masses;
  problem.fixed = fixed;
  problem.gravity = Vec3(0, -9.8, 0);
  problem.dt = dt;
  for (const SpringRun& run : lattice_springs.runs) {
    for (int i = 0; i < run.length; ++i) {
      problem.springs.push_back({run.a + i, run.b + i, springs->stiffness(run.direction, run.first + i),
                                 springs->rest_length(run.direction)});
    }
  }
  return problem;
}

double Problem::stiffness_number() const {
  double heaviest = 0;
  for (const double m : masses) heaviest = std::max(heaviest, m);
  return moduli[0] * lattice.width * dt * dt / heaviest;
}

Problem make_problem(const ProblemSettings& settings) {
  Problem problem;
  problem.name = settings.name;
  problem.dt = settings.dt;
  problem.lattice = test::box_lattice(settings.extent, settings.width);
  problem.lattice_springs = build_springs(problem.lattice, Bracing::kuhn);
  problem.springs = std::make_shared<SpringEnergy>(problem.lattice_springs, settings.width, moduli);
  problem.state.positions = test::rest_positions(problem.lattice);
  const std::size_t count = problem.state.positions.size();
  problem.state.velocities.assign(count, Vec3::Zero());
  problem.masses.assign(count, 0);
  const double corner = density * std::pow(settings.width, 3) / 8;
  for (const auto& corners : problem.lattice.voxel_vertices)
    for (const int v : corners) problem.masses[static_cast<std::size_t>(v)] += corner;
  problem.gravity = std::make_shared<test::UniformGravity>(problem.masses, Vec3(0, -9.8, 0));
  problem.fixed.assign(count, 0);
  const Vec3i& e = problem.lattice.extent;
  for (std::size_t v = 0; v < count; ++v) {
    const Vec3i& at = problem.lattice.vertices[v];
    problem.fixed[v] = at.y() == e.y() && (at.x() == 0 || at.x() == e.x()) ? 1 : 0;
  }
  if (settings.crumpled) crumple(problem.lattice, problem.state.positions);

  SolverSettings solver;
  solver.tolerance = 0.1;
  for (int n = 0; n < settings.steps; ++n) {
    const StepContext context = step_context(solver.integrator, problem.state, problem.dt);
    const StepReport report = solve_step(solver, context, problem.step_problem(), problem.state);
    if (!report.converged) throw std::runtime_error(settings.name + ": " + report.failure);
  }
  return problem;
}

}  // namespace muslin::bench
