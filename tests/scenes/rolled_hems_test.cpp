// Rolled hems: with internal friction cloth keeps its curl, without it hangs down again.
#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

TEST(RolledHems, OnlyTheOneWithFrictionKeepsItsCurl) {
  SceneRun run("rolled_hems.toml", {"solver.effort=draft"});
  run.until_frame(28);
  for (const char* hem : {"elastic hem", "rubbing hem"}) EXPECT_GT(run.probe(hem).y(), 0.04) << hem;
  run.until_frame(60);
  EXPECT_LT(run.probe("elastic hem").y(), 0.005);
  EXPECT_GT(run.probe("rubbing hem").y(), 0.02);
  EXPECT_GT(run.probe("rubbing hem").z(), 0.01);
}

}  // namespace
}  // namespace muslin::test
