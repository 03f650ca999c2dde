// Rolled hems: with internal friction cloth keeps a curl, without it hangs down again.
#include <cmath>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

TEST(RolledHems, OnlyTheOneWithFrictionKeepsACurl) {
  SceneRun run("rolled_hems.toml", {"solver.effort=draft"});
  run.until_frame(16);
  for (const char* hem : {"elastic hem", "rubbing hem"}) EXPECT_GT(run.probe(hem).y(), 0.025) << hem;
  // Both swing: the mean of 12 frames.
  Vec3 elastic = Vec3::Zero(), rubbing = Vec3::Zero();
  for (int frame = 25; frame <= 36; ++frame) {
    run.until_frame(frame);
    elastic += run.probe("elastic hem") / 12;
    rubbing += run.probe("rubbing hem") / 12;
  }
  EXPECT_LT(std::abs(elastic.z()), 0.004);
  EXPECT_LT(elastic.y(), 0.003);
  EXPECT_GT(rubbing.z(), 0.01);
  EXPECT_GT(rubbing.y(), 0.008);
}

}  // namespace
}  // namespace muslin::test
