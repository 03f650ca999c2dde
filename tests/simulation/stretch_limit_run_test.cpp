// Weak cloth that hangs from two corners: a limit of stretch holds, from the start and from far beyond, and
// the account of energy closes with it.
#include <cmath>
#include <memory>

#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

/// A square metre of n by n squares, level at the start, in steps of 1/120 s.
Model hanging(int n, const std::string& more, double stretched = 1) {
  Scene scene = parse_scene(R"([time]
frame_rate = 30
steps_per_frame = 4
duration = 3
[solver]
tolerance = 1e-4
[[body]]
name = "cloth"
mesh = "sheet.obj"
rest_mesh = "rest.obj"
model = "shell"
warp = [1, 0, 0]
material = { areal_density = 0.15, membrane_warp = 60, membrane_shear = 20, poisson = 0.2, bending_warp = 1e-5 }
)" + more + R"([[pin]]
where = { nearest = [[0, 0, 0], [)" +
                                std::to_string(stretched) + R"(, 0, 0]] }
[[force]]
type = "gravity"
)",
                            "scene.toml");
  auto rest = std::make_shared<Mesh>(test::flat_sheet(n, n, 1, 1));
  auto mesh = std::make_shared<Mesh>(*rest);
  for (Vec3& p : mesh->positions) p *= stretched;
  scene.meshes["sheet.obj"] = mesh;
  scene.meshes["rest.obj"] = rest;
  return build_model(scene);
}

std::shared_ptr<const Model> shared(Model model) { return std::make_shared<const Model>(std::move(model)); }

TEST(StretchLimitRun, HoldsWhileTheSheetFallsAndHangs) {
  constexpr double rounding = 1e-12;  // [J], of 1 J that the sheet falls
  double without = 1, with = 1;
  Simulation weak(shared(hanging(12, ""))), limited(shared(hanging(12, "stretch_limit = 1.05\n")));
  const double balance = limited.diagnostics().balance();
  for (int frame = 0; frame < 45; ++frame) {
    weak.advance();
    limited.advance();
    without = std::max(without, weak.diagnostics().max_stretch);
    with = std::max(with, limited.diagnostics().max_stretch);
    EXPECT_NEAR(limited.diagnostics().balance() - limited.diagnostics().unbalanced, balance, rounding);
  }
  EXPECT_GT(without, 1.2);
  EXPECT_LT(with, 1.06);
  EXPECT_GT(with, 1.025);
}

TEST(StretchLimitRun, PullsBackASheetOfThreeTimesItsLength) {
  Model model = hanging(12, "stretch_limit = 1.05\n", 3);
  model.pins.resize(0);
  Simulation simulation(shared(std::move(model)));
  for (int frame = 0; frame < 30; ++frame) simulation.advance();
  EXPECT_LT(simulation.diagnostics().max_stretch, 1.06);
}

TEST(StretchLimitRun, LimitAddedOnResumeCountsAsWork) {
  Simulation weak(shared(hanging(8, "")));
  for (int frame = 0; frame < 20; ++frame) weak.advance();
  Simulation limited(shared(hanging(8, "stretch_limit = 1.03\n")));
  limited.restore(weak.checkpoint());
  const double balance = weak.diagnostics().balance();
  for (int frame = 0; frame < 20; ++frame) limited.advance();
  const Diagnostics& last = limited.diagnostics();
  EXPECT_GT(last.work, weak.diagnostics().work + 1);
  EXPECT_NEAR(last.balance() - last.unbalanced, balance - weak.diagnostics().unbalanced,
              1e-3 * (last.work - weak.diagnostics().work));
  EXPECT_LT(last.max_stretch, 1.04);
}

}  // namespace
}  // namespace muslin
