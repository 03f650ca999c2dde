// The drawn curtain: its rings slide to 40 % of the width, give way by the weight that each carries, and
// carry all of it.
#include <string>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

TEST(DrawnCurtain, HangsFromItsRingsWhereTheyWereDrawn) {
  SceneRun run("drawn_curtain.toml", {"solver.effort=draft"});
  run.until_frame(66);
  const Vec3 ring = run.probe("last ring");
  EXPECT_NEAR(ring.x(), 0.4 * 1.4, 0.005);
  EXPECT_LT(ring.y(), 1.3);
  EXPECT_GT(ring.y(), 1.29);
  double carried = 0;
  for (int k = 1; k <= 9; ++k) carried += run.simulation().pin_force("ring " + std::to_string(k)).sum.y();
  const double weight = 9.81 * run.body().statistics.mass;
  EXPECT_NEAR(carried, weight, 0.1 * weight);
}

}  // namespace
}  // namespace muslin::test
