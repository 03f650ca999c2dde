// Creased paper: folded and let go, the elastic strip lies flat again, and the paper one keeps a crease.
#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

TEST(CreasedPaper, OnlyTheOneThatYieldsKeepsACrease) {
  SceneRun run("creased_paper.toml", {"solver.effort=draft"});
  run.until_frame(24);
  for (const char* flap : {"elastic flap", "paper flap"}) EXPECT_GT(run.probe(flap).y(), 0.04) << flap;
  run.until_frame(36);
  EXPECT_LT(run.probe("elastic flap").y(), 0);
  EXPECT_GT(run.probe("paper flap").y(), 0.045);
  EXPECT_LT(run.probe("paper flap").x(), 0.05);
}

}  // namespace
}  // namespace muslin::test
