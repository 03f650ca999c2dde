#include "muslin/simulation/simulated_body.hpp"

#include <algorithm>
#include <memory>

#include "support/sheet.hpp"
#include "support/simple_potentials.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin::test {
namespace {

/// Two sheets that fall apart from each other, and a ball that stands still.
std::shared_ptr<const Model> two_sheets() {
  Scene scene = parse_scene(R"(
[time]
duration = 0.5
steps_per_frame = 2
[[body]]
name = "left"
mesh = "sheet"
model = "shell"
material = "cotton"
stretch_limit = 10
contact = false
[[body]]
name = "right"
mesh = "sheet"
model = "shell"
material = "cotton"
stretch_limit = 10
contact = false
translate = [1, 0, 0]
[[collider]]
name = "ball"
shape = "sphere"
radius = 0.1
center = [0, -9, 0]
[[force]]
type = "gravity"
acceleration = [0, -10, 0]
[[probe]]
name = "corner"
body = "right"
at = [1, 0, 0]
)",
                            "scene.toml");
  scene.meshes["sheet"] = std::make_shared<const Mesh>(flat_sheet(3, 3, 0.3, 0.3));
  return std::make_shared<const Model>(build_model(scene));
}

TEST(SimulatedBody, HasTheMotionOfItsVertices) {
  Simulation simulation(two_sheets());
  for (int frame = 0; frame < 6; ++frame) simulation.advance();
  const SimulatedBody right = simulation.body("right");
  EXPECT_EQ(right.name(), "right");
  ASSERT_EQ(right.positions().size(), 16u);
  EXPECT_NEAR(right.positions()[0].x(), 1, 1e-9);
  EXPECT_NEAR(right.velocities()[0].y(), -2.5, 1e-6);
  EXPECT_EQ(right.points()[0], right.positions()[0]);
  EXPECT_EQ(simulation.probe("corner"), right.positions()[0]);
  EXPECT_NEAR(right.stretch(), 1, 1e-6);
  const Vec3 start = simulation.model().body("ball").mesh.positions.front();
  EXPECT_LT((simulation.body("ball").points().front() - start).norm(), 1e-12);
}

TEST(SimulatedBody, ForceActsOnItOnly) {
  Simulation simulation(two_sheets());
  SimulatedBody left = simulation.body("left");
  std::size_t seen = 0;
  left.add_force("lift", [&](double, ConstVectors x, ConstVectors v, Vectors f) {
    seen = f.size();
    EXPECT_EQ(x.size(), f.size());
    EXPECT_EQ(v.size(), f.size());
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = 10 * simulation.model().masses[i] * Vec3::UnitY();
  });
  for (int frame = 0; frame < 6; ++frame) simulation.advance();
  EXPECT_EQ(seen, 16u);
  EXPECT_NEAR(left.velocities()[5].y(), 0, 1e-9);
  EXPECT_NEAR(simulation.body("right").velocities()[5].y(), -2.5, 1e-6);
}

/// The energy it has when it is added counts as work from outside; from then on it is stored.
TEST(SimulatedBody, PotentialActsOnItOnlyAndIsInTheBalance) {
  const auto model = two_sheets();
  Simulation simulation(model);
  const double before = simulation.diagnostics().balance();
  simulation.body("right").add_potential("well", EnergyRole::potential, std::make_shared<Wells>(1.0));
  for (int frame = 0; frame < 6; ++frame) simulation.advance();
  EXPECT_LT(simulation.body("right").velocities()[0].x(), -0.1);
  EXPECT_NEAR(simulation.body("left").velocities()[0].x(), 0, 1e-6);  // as far as steps are solved
  double stored = 0;
  for (const Vec3& x : model->of(model->body("right"), model->rest_positions))
    stored += 0.5 * x.squaredNorm();
  const Diagnostics& now = simulation.diagnostics();
  EXPECT_NEAR(now.work, stored, 1e-9 * stored);
  EXPECT_NEAR(now.balance(), before, 1e-3 * stored);
}

TEST(SimulatedBody, UnknownNamesAreErrorsThatNameTheNearest) {
  Simulation simulation(two_sheets());
  const auto expect = [](const auto& call, const std::string& message) {
    try {
      call();
      ADD_FAILURE() << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_THAT(error.what(), testing::HasSubstr(message));
    }
  };
  expect([&] { simulation.body("rihgt"); }, "the model has no body `rihgt`; did you mean `right`?");
  expect([&] { simulation.probe("top"); }, "the model has no probe `top`");
  expect([&] { simulation.model().body_of(1000); }, "the model has no vertex 1000");
  expect([&] { simulation.body("left").add_potential("none", EnergyRole::work, nullptr); },
         "\"none\" is null");
  expect([&] { simulation.add_load({"none", EnergyRole::work, nullptr}); }, "\"none\" is null");
}

TEST(SimulatedBody, BodyOfAVertexOwnsIt) {
  const auto model = two_sheets();
  EXPECT_EQ(model->body_of(0).name, "left");
  EXPECT_EQ(model->body_of(15).name, "left");
  EXPECT_EQ(model->body_of(16).name, "right");
  EXPECT_EQ(model->body_of(model->vertex_count() - 1).name, "ball");
}

}  // namespace
}  // namespace muslin::test
