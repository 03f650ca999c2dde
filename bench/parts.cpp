#include "parts.hpp"

#include "clock.hpp"

#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/pcg_solver.hpp"

namespace muslin::bench {
namespace {

/// Bytes a vertex and iteration of conjugate gradients on a lattice larger than the caches, by count. For
/// each position, backwards: r read (12, float), x and p updated (48), M and A − D read (32 and a unit a
/// group), c and t written (24); forwards: c and t read (24), r updated (24), M read (16), w written (12).
/// For each block of 16 couplings, in either sweep: 128 of coefficients, a unit, and a Block or a Link.
double counted_bytes(const Problem& problem) {
  const SpringNetwork& network = *problem.springs->network();
  const EliminationOrder pattern(network.runs, network.vertex_count);
  const auto positions = static_cast<double>(pattern.position_count());
  const auto blocks = static_cast<double>(pattern.block_count()),
             links = static_cast<double>(pattern.links().size());
  return (192.75 * positions + blocks * (2 * 132 + sizeof(EliminationOrder::Block)) +
          links * sizeof(EliminationOrder::Link)) /
         static_cast<double>(problem.masses.size());
}

}  // namespace

std::map<std::string, double> parts_of_a_step(const Problem& problem) {
  const std::size_t count = problem.masses.size();
  StepProblem step = problem.step_problem();
  step.rest_positions = {};  // iterations without the coarse space
  const StepContext context = step_context(Integrator::implicit_euler, problem.state, problem.dt);
  const IncrementalPotential function(step, context.inertial_prediction, problem.dt);
  const std::vector<Vec3>& x = problem.state.positions;
  std::vector<Vec3> g(count), s(count);
  PcgSolver pcg;
  double norm = 0;

  std::map<std::string, double> parts;
  const auto per_vertex = [&](const Least& time, double calls = 1) {
    return 1e9 * time.seconds / (static_cast<double>(count) * calls);
  };
  volatile double energy = 0;
  parts["energy_ns"] = per_vertex(Least::of([&] { energy = function.value(x).value; }));
  parts["gradient_ns"] = per_vertex(Least::of([&] { function.gradient(x, g); }));
  parts["linearise_ns"] = per_vertex(Least::of([&] { pcg.linearize(function, x); }));
  // A long solve less a short one, so that what happens once per solve drops out.
  LinearSettings linear;
  linear.tolerance = 0;
  linear.negative_curvature = NegativeCurvature::pass;
  const auto solve = [&](int iterations) {
    linear.max_iterations = iterations;
    return Least::of([&] { pcg.solve(g, linear, s, norm); });
  };
  constexpr int few = 4, many = 24;
  parts["iteration_ns"] = per_vertex(solve(many), many - few) - per_vertex(solve(few), many - few);
  parts["iteration_bytes"] = counted_bytes(problem);
  return parts;
}

}  // namespace muslin::bench
