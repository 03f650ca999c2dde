// The marionette: the cross raises one hand and lowers the other, and the joints of its limbs hold.
#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

TEST(Marionette, RaisesItsHandsInTurnAndHoldsTogether) {
  SceneRun run("marionette.toml");
  const double level = run.probe("right hand").y();
  run.until_frame(12);  // the cross is highest at the right
  EXPECT_GT(run.probe("right hand").y(), level + 0.02);
  EXPECT_GT(run.probe("right hand").y(), run.probe("left hand").y() + 0.02);
  run.until_frame(30);  // at the left
  EXPECT_GT(run.probe("left hand").y(), run.probe("right hand").y() + 0.02);
  for (const char* joint : {"neck", "left shoulder", "right shoulder", "left hip", "right hip"})
    EXPECT_EQ(run.simulation().attachment_force(joint).holding, 4) << joint;
  run.until_frame(60);
  EXPECT_NEAR(run.probe("head").z(), 0.2, 0.1) << "it follows the cross";
  EXPECT_NEAR(run.probe("head").y(), 0.57, 0.03);
}

}  // namespace
}  // namespace muslin::test
