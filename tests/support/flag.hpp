// The thesis's flag as a solver problem: 10 × 6 × 1 voxels of width 1 m (or any other size and width), 10
// kg/m³, springs of 20000/100/100 N/m² × width, gravity −9.8 m/s².
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "support/lattice_box.hpp"
#include "support/simple_potentials.hpp"

#include "muslin/energy/spring_energy.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin::test {

struct Flag {
  Lattice lattice;
  std::vector<Vec3> rest;
  std::vector<double> masses;
  std::vector<std::uint8_t> fixed;
  std::vector<Vec3> targets;
  std::shared_ptr<const SpringEnergy> springs;
  std::shared_ptr<const UniformGravity> gravity;
  State state;

  explicit Flag(const Vec3i& extent = {10, 6, 1}, const std::array<double, 3>& moduli = {20000, 100, 100},
                double width = 1)
      : lattice(box_lattice(extent, width)), rest(rest_positions(lattice)), masses(rest.size(), 0) {
    for (const auto& corners : lattice.voxel_vertices) {
      for (const int v : corners) masses[static_cast<std::size_t>(v)] += 10.0 / 8 * width * width * width;
    }
    springs = std::make_shared<SpringEnergy>(build_springs(lattice, Bracing::kuhn), width, moduli);
    gravity = std::make_shared<UniformGravity>(masses, Vec3(0, -9.8, 0));
    fixed.assign(rest.size(), 0);
    targets = rest;
    state.positions = rest;
    state.velocities.assign(rest.size(), Vec3::Zero());
  }

  int vertex(int i, int j, int k) const {
    return (j * (lattice.extent.z() + 1) + k) * (lattice.extent.x() + 1) + i;
  }
  const Vec3& at(int i, int j, int k) const {
    return state.positions[static_cast<std::size_t>(vertex(i, j, k))];
  }
  /// Holds the vertices that `where` (integer coordinates) chooses.
  void hold(const std::function<bool(const Vec3i&)>& where) {
    for (std::size_t v = 0; v < rest.size(); ++v) fixed[v] = where(lattice.vertices[v]) ? 1 : 0;
  }
  void hold_top_corners() {
    const Vec3i e = lattice.extent;
    hold([&](const Vec3i& c) { return c.y() == e.y() && (c.x() == 0 || c.x() == e.x()); });
  }
  StepProblem problem() const { return {masses, {springs.get(), gravity.get()}, fixed, targets}; }

  StepReport step(const SolverSettings& settings, double dt) {
    const StepContext context = step_context(settings.integrator, state, dt);
    return solve_step(settings, context, problem(), state);
  }
};

}  // namespace muslin::test
