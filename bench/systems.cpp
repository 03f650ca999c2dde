#include "systems.hpp"

#include <cstdio>
#include <stdexcept>

#include "clock.hpp"
#include "support/sheet.hpp"
#include "support/simple_potentials.hpp"

#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/shell_bending.hpp"
#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/pcg_solver.hpp"

namespace muslin::bench {

std::map<std::string, double> lattice_system(const Problem& problem, double dt) {
  const std::size_t count = problem.masses.size();
  const StepProblem step = problem.step_problem();
  State state = problem.state;
  const StepContext context = step_context(Integrator::implicit_euler, state, dt);
  const IncrementalPotential function(step, context.inertial_prediction, dt);
  std::vector<Vec3> g(count), s(count);
  function.gradient(state.positions, g);
  std::map<std::string, double> counters;
  PcgSolver pcg;
  for (const char* tolerance : {"1e-1", "1e-3", "1e-5"}) {
    LinearSettings linear;
    linear.tolerance = std::stod(tolerance);
    // The first solve shows how long one takes; the second one knows.
    pcg.begin_step();
    pcg.linearize(function, state.positions);
    pcg.project();
    double norm;
    pcg.solve(g, linear, s, norm);
    LinearReport report;
    const Clock clock;
    report = pcg.solve(g, linear, s, norm);
    counters[std::string("system_") + tolerance + "_ms"] = 1e3 * clock.seconds();
    counters[std::string("iterations_") + tolerance] = report.iterations;
  }
  counters["stiffness_number"] = problem.stiffness_number() * (dt / problem.dt) * (dt / problem.dt);
  return counters;
}

std::map<std::string, double> cloth_steps(int n, bool coarse_space) {
  Mesh mesh = test::flat_sheet(n, n, 1, 1);
  test::add_flat_uvs(mesh);
  const Shell shell = build_shell(mesh, mesh.positions, {});
  const auto pattern = block_pattern(shell);
  const MembraneEnergy membrane(shell, {1000, 1000, 400, 0.3}, pattern);
  const ShellBending bending(shell, {1e-5, 1e-5, 1e-5}, pattern);
  std::vector<double> masses;
  for (const double area : shell.vertex_areas) masses.push_back(0.2 * area);
  const test::UniformGravity gravity(masses, Vec3(0, -9.8, 0));
  std::vector<std::uint8_t> fixed(masses.size(), 0);
  fixed[0] = fixed[static_cast<std::size_t>(n)] = 1;
  State state;
  state.positions = mesh.positions;
  state.velocities.assign(masses.size(), Vec3::Zero());
  StepProblem problem{masses, {&membrane, &bending, &gravity}, fixed, mesh.positions};
  if (coarse_space) problem.rest_positions = mesh.positions;
  SolverSettings settings;
  constexpr int before = 12, measured = 12;
  Stepper stepper;
  std::map<std::string, double> counters;
  for (int i = 0; i < before + measured; ++i) {
    const Clock clock;
    const StepContext context = step_context(settings.integrator, state, 1.0 / 240);
    const StepReport report = stepper.step(settings, context, problem, state);
    if (!report.converged) throw std::runtime_error("cloth: " + report.failure);
    if (i < before) continue;
    counters["steps_ms"] += 1e3 * clock.seconds() / measured;
    counters["newton"] += static_cast<double>(report.newton_iterations) / measured;
    counters["linear"] += static_cast<double>(report.linear_iterations) / measured;
  }
  counters["vertices"] = static_cast<double>(masses.size());
  counters["bytes_per_vertex"] = static_cast<double>(stepper.bytes()) / static_cast<double>(masses.size());
  return counters;
}

}  // namespace muslin::bench
