// Balloons: a membrane that a gas blows up comes to rest where Laplace's law holds, in steps that converge.
#include <cmath>
#include <memory>

#include "support/ball_surface.hpp"
#include <gtest/gtest.h>

#include "muslin/component/shell/shell_body.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/pressure_energy.hpp"
#include "muslin/potential/mass_damping.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

constexpr double radius = 0.1, stiffness = 500, poisson = 0.3;  // [m], Young's modulus × thickness [N/m]

struct Balloon {
  std::shared_ptr<const EnclosedVolume> volume;
  Model model;

  explicit Balloon(const Gas& gas) {
    const test::Surface surface = test::ball(14, radius);
    volume = std::make_shared<const EnclosedVolume>(surface.triangles, surface.x.size());
    const auto shell = std::make_shared<ShellBody>();
    ShellBody& body = *shell;
    body.name = "balloon";
    body.settings.material.shell = ShellMaterial{};
    body.mesh.positions = surface.x;
    body.mesh.face_offsets = {0};
    for (const Vec3i& t : surface.triangles) {
      for (const int v : t) body.mesh.face_vertices.push_back(v);
      body.mesh.face_offsets.push_back(static_cast<int>(body.mesh.face_vertices.size()));
    }
    body.shell = build_shell(body.mesh, surface.x, {Vec3(0.3, 1, 0.2)});
    body.vertex_count = static_cast<int>(surface.x.size());
    model.scene.title = "balloon";
    model.scene.resolved = "{}";
    model.scene.time = {10, 50, 4};
    model.scene.solver.tolerance = 1e-5;
    model.scene.bodies.emplace_back().name = body.name;
    model.rest_positions = surface.x;
    for (const double area : body.shell.vertex_areas) model.masses.push_back(0.1 * area);
    const double shear = stiffness / (2 * (1 + poisson));
    const MembraneModuli moduli{stiffness, stiffness, shear, poisson};
    model.potentials.push_back(
        {"membrane", EnergyRole::elastic,
         std::make_shared<MembraneEnergy>(body.shell, moduli, block_pattern(body.shell))});
    model.potentials.push_back({"gas", EnergyRole::potential, std::make_shared<PressureEnergy>(volume, gas)});
    model.loads.push_back({"drag", EnergyRole::dissipation, std::make_shared<MassDamping>(20, model.masses)});
    model.bodies.push_back(shell);
  }
};

/// Pressure that holds a balloon of this stretch: with the second Piola-Kirchhoff stress S the tension is S
/// per present length, and p = 2 S/r.
double holding_pressure(double stretch) {
  return stiffness / (1 - poisson) * (stretch * stretch - 1) / (stretch * radius);
}

TEST(Balloon, RestsAtTheRadiusOfLaplacesLaw) {
  const double rest_volume = Balloon({1000, 0, 0}).volume->value(test::ball(14, radius).x);
  for (const Gas& gas : {Gas{1000, 0, 0}, Gas{20000, 101325, rest_volume}}) {
    Balloon balloon(gas);
    const auto volume = balloon.volume;
    Simulation simulation(std::make_shared<const Model>(std::move(balloon.model)));
    int steps = 0, converged = 0, newton = 0;
    while (simulation.frame() < 50) {
      simulation.advance();
      steps += simulation.diagnostics().steps;
      converged += simulation.diagnostics().converged_steps;
      newton += simulation.diagnostics().newton_iterations;
    }
    EXPECT_EQ(converged, steps);
    EXPECT_LT(newton, 6 * steps);
    const double now = volume->value(simulation.state().positions);
    const double stretch = std::cbrt(now / rest_volume);
    EXPECT_GT(stretch, 1.05);
    EXPECT_NEAR(gas.at(now).pressure / holding_pressure(stretch), 1, 0.02);
    EXPECT_LT(simulation.diagnostics().kinetic, 1e-4 * simulation.diagnostics().elastic);
  }
}

}  // namespace
}  // namespace muslin
