// yield_curvature, yield_hardening and yield_recovery of a shell: a strip keeps a crease, loses it again in
// time, and its losses are in the energy balance; resumed runs have the same bits; what is wrong.
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/rolled_strip.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr double rolled_to = 30, yield = 10;  // [1/m]
const std::string paper = "bending_warp = 1e-4, yield_curvature = 10";

/// A strip of 7 by 3 squares, the first row clamped.
Scene strip(const std::string& keys) {
  Scene scene = parse_scene(R"([time]
frame_rate = 5000
duration = 1
steps_per_frame = 1
[solver]
integrator = "implicit_euler"
[[body]]
name = "cloth"
mesh = "strip.obj"
model = "shell"
warp = [1, 0, 0]
contact = false
material = { areal_density = 0.1, membrane_warp = 50, poisson = 0, mass_damping = 60, )" +
                                keys + R"( }
[[pin]]
where = { plane = { point = [0, 0, 0], normal = [1, 0, 0], distance = 0.011 } }
)",
                            "scene.toml");
  scene.meshes["strip.obj"] = test::strip_mesh();
  return scene;
}
std::shared_ptr<const Model> model(const std::string& keys) {
  return std::make_shared<const Model>(build_model(strip(keys)));
}

double kept(double hardening) { return (1 - hardening) * (rolled_to - yield); }

/// The run after it was rolled up, and unrolled but for 2/m of what springs back: waves of more would yield.
Simulation rolled_up(const std::shared_ptr<const Model>& model, double hardening = 0) {
  Simulation simulation(model);
  simulation.advance();
  simulation.set_positions(test::rolled_strip(*model, rolled_to));
  simulation.advance();
  simulation.set_positions(test::rolled_strip(*model, kept(hardening) + 2));
  return simulation;
}

/// The run after 0.4 s.
Simulation settled(const std::string& keys, double hardening = 0) {
  Simulation simulation =
      rolled_up(model(keys + ", yield_hardening = " + std::to_string(hardening)), hardening);
  const Diagnostics start = simulation.diagnostics();
  double dissipated = start.dissipated;
  while (simulation.frame() < 2000) {
    simulation.advance();
    const Diagnostics& row = simulation.diagnostics();
    EXPECT_NEAR(row.balance() - row.unbalanced, start.balance() - start.unbalanced, 1e-12);
    EXPECT_GE(row.dissipated, dissipated - 1e-9);  // of energies of 1e-4 J
    dissipated = row.dissipated;
  }
  return simulation;
}

TEST(PlasticShell, StripThatIsLetGoKeepsWhatIsBeyondYieldAndItsAccountCloses) {
  for (const double hardening : {0.0, 0.2}) {
    const Simulation simulation = settled(paper, hardening);
    const auto [least, greatest] = test::strip_curvatures(simulation);
    EXPECT_NEAR(least / kept(hardening), 1, 0.02) << hardening;
    EXPECT_NEAR(greatest / kept(hardening), 1, 0.02) << hardening;
  }
}

TEST(PlasticShell, CreaseFadesWithTheTimeOfRecovery) {
  const Simulation simulation = settled(paper + ", yield_recovery = 0.02");
  EXPECT_LT(test::strip_curvatures(simulation).second, 0.01 * rolled_to);
}

TEST(PlasticShell, ResumedRunAndAnyNumberOfThreadsHaveTheSameBits) {
  const auto strip = model(paper + ", yield_recovery = 0.5");
  set_thread_count(1);
  Simulation whole = rolled_up(strip);
  for (int frame = 0; frame < 2; ++frame) whole.advance();
  set_thread_count(3);
  Simulation resumed(strip);
  resumed.restore(whole.checkpoint());
  for (int frame = 0; frame < 2; ++frame) {
    set_thread_count(1);
    whole.advance();
    set_thread_count(3);
    resumed.advance();
    resumed.forget_scratch();
  }
  set_thread_count(0);
  EXPECT_EQ(whole.checkpoint(), resumed.checkpoint());
}

TEST(PlasticShell, WrongNumbersAreErrors) {
  const auto message = [](const std::string& keys) -> std::string {
    try {
      strip(keys);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message("bending_warp = 1e-4, yield_curvature = 0"), testing::HasSubstr("is 0; give a number"));
  EXPECT_THAT(message(paper + ", yield_hardening = 2"),
              testing::HasSubstr("is 2; give a number from 0 to 1"));
  EXPECT_THAT(message(paper + ", yield_recovery = 0"), testing::HasSubstr("yield_recovery"));
  EXPECT_THAT(message("bending_warp = 1e-4, yield_hardening = 0.5"),
              testing::HasSubstr("a sheet without `yield_curvature` does not crease"));
  EXPECT_THAT(message("bending_warp = 0, yield_curvature = 10"), testing::HasSubstr("give `bending_warp`"));
  EXPECT_THAT(message("bending_warp_curve = [[10, 1e-3]], yield_curvature = 10"),
              testing::HasSubstr("in place of the curves"));
}

}  // namespace
}  // namespace muslin
