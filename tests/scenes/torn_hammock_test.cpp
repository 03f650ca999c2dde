// The torn hammock: one seam holds, the other tears from the side of the ball, and contact leaves both alone.
#include "support/scene_run.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"

namespace muslin::test {
namespace {

TEST(TornHammock, OneSeamTearsAndTheBallFalls) {
  SceneRun run("torn_hammock.toml");
  const auto holding = [&](const char* seam) { return run.simulation().attachment_force(seam).holding; };
  run.until_frame(5);
  EXPECT_EQ(holding("right seam"), 25);
  bool tears = false;  // some joints have broken, others hold
  while (run.simulation().frame() < 8) {
    run.step();
    tears = tears || (holding("right seam") > 0 && holding("right seam") < 25);
  }
  EXPECT_TRUE(tears);
  run.until_frame(14);
  EXPECT_EQ(holding("right seam"), 0);
  EXPECT_EQ(holding("left seam"), 25);
  EXPECT_LT(run.probe("ball").y(), 0.2);
  EXPECT_TRUE(find_crossings(*run.model().contact, run.now()).empty());
}

}  // namespace
}  // namespace muslin::test
