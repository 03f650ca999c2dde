// The napkin: facts that hold whatever the numbers of its cotton.
#include <cmath>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

TEST(Napkin, FallsHangsAndKeepsItsLength) {
  SceneRun run("napkin.toml", {"solver.effort=draft"});
  EXPECT_TRUE(as_shell(run.body()) != nullptr);
  EXPECT_NEAR(run.body().statistics.mass, 0.1503 * 0.16, 1e-9);
  run.until_frame(6);
  // It swings down, even on both sides.
  const Vec3 hem = run.probe("middle of the hem");
  EXPECT_LT(hem.y(), -0.15);
  EXPECT_GT(hem.y(), -0.45);
  EXPECT_LT(std::abs(hem.x()), 0.05);
  EXPECT_LT(run.simulation().diagnostics().max_stretch, 1.2);
  // The hands came together by 1.5 cm each.
  for (const Pin& pin : run.model().pins) {
    ASSERT_EQ(pin.vertices.size(), 1u);
    const auto v = static_cast<std::size_t>(pin.vertices[0]);
    EXPECT_NEAR((run.now()[v] - run.rest()[v]).norm(), 0.015, 1e-9);
  }
}

}  // namespace
}  // namespace muslin::test
