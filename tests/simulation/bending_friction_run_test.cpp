// A clamped strip with internal friction is rolled up and let go: it stays bent, its loss is in the energy
// balance, and a resumed run has the same bits.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "support/rolled_strip.hpp"
#include <gtest/gtest.h>

namespace muslin {
namespace {

constexpr double rigidity = 1e-4, friction = 1e-3;  // [N·m], [N]
constexpr double rolled_to = 30;                    // [1/m]

/// A strip of 7 by 3 squares, the first row clamped.
std::shared_ptr<const Model> strip(const std::string& limits, const std::string& time = "steps_per_frame = 2",
                                   const std::string& integrator = "implicit_euler") {
  Scene scene = parse_scene("[time]\nframe_rate = 50\nduration = 4\n" + time + "\n[solver]\nintegrator = \"" +
                                integrator + R"("
[[body]]
name = "cloth"
mesh = "strip.obj"
model = "shell"
warp = [1, 0, 0]
contact = false
material = { areal_density = 0.1, membrane_warp = 50, poisson = 0, bending_warp = 1e-4, mass_damping = 120)" +
                                limits + R"( }
[[pin]]
where = { plane = { point = [0, 0, 0], normal = [1, 0, 0], distance = 0.011 } }
)",
                            "scene.toml");
  scene.meshes["strip.obj"] = test::strip_mesh();
  return std::make_shared<const Model>(build_model(scene));
}
const std::string with_friction = ", bending_friction_warp = 1e-3, bending_friction_curvature = 2";

/// The run after a first frame, flat and at rest, in which it was rolled up.
Simulation rolled_up(const std::shared_ptr<const Model>& model) {
  Simulation simulation(model);
  simulation.advance();
  simulation.set_positions(test::rolled_strip(*model, rolled_to));
  return simulation;
}

TEST(BendingFrictionRun, StripThatIsLetGoStaysBentByTheFrictionOverItsRigidity) {
  Simulation simulation = rolled_up(strip(with_friction));
  EXPECT_NEAR(test::strip_curvatures(simulation).second, rolled_to, 0.1);
  while (simulation.frame() < 100) simulation.advance();
  const auto [least, greatest] = test::strip_curvatures(simulation);
  EXPECT_LE(greatest, 1.01 * friction / rigidity);
  EXPECT_GE(least, 0.99 * friction / rigidity);

  Simulation elastic = rolled_up(strip(""));
  while (elastic.frame() < 100) elastic.advance();
  EXPECT_LT(test::strip_curvatures(elastic).second, 0.01 * friction / rigidity);
}

class BendingFrictionBalance : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Integrators, BendingFrictionBalance,
                         testing::Values("implicit_euler", "bdf2", "linearly_implicit_euler",
                                         "symplectic_euler"),
                         [](const auto& info) { return info.param; });

// tests/energy/bending_friction_test compares the loss itself with the area of the loop.
TEST_P(BendingFrictionBalance, ClosesWithItsLoss) {
  const auto lost = [](const std::string& limits) {
    Simulation simulation = rolled_up(strip(limits, "steps_per_frame = 200", GetParam()));
    const Diagnostics start = simulation.diagnostics();
    const double balance = start.balance() - start.unbalanced;
    double dissipated = start.dissipated;
    while (simulation.frame() < 12) {
      simulation.advance();
      const Diagnostics& row = simulation.diagnostics();
      EXPECT_NEAR(row.balance() - row.unbalanced, balance, 1e-12);
      EXPECT_LT(std::abs(row.unbalanced), 1e-6);  // of energies of 1e-4 J
      EXPECT_GE(row.dissipated, dissipated - 1e-6);
      dissipated = row.dissipated;
    }
    return dissipated / (dissipated + simulation.diagnostics().elastic);
  };
  // Friction keeps the strip bent, so that a tenth of the energy stays stored.
  EXPECT_NEAR(lost(with_friction), 0.89, 0.01);
  EXPECT_GT(lost(""), 0.97);
}

TEST(BendingFrictionRun, ResumedRunHasTheSameBits) {
  const auto model = strip(with_friction, "steps_per_frame = \"auto\"");
  Simulation whole = rolled_up(model);
  for (int frame = 0; frame < 5; ++frame) whole.advance();
  Simulation resumed(model);
  resumed.restore(whole.checkpoint());
  for (int frame = 0; frame < 5; ++frame) {
    whole.advance();
    resumed.advance();
    resumed.forget_scratch();
  }
  EXPECT_EQ(whole.checkpoint(), resumed.checkpoint());
}

}  // namespace
}  // namespace muslin
