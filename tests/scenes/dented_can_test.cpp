// The dented can: the thumb has gone, and the dent stays; without yield the wall springs back.
#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

TEST(DentedCan, KeepsItsDentBecauseItYields) {
  SceneRun can("dented_can.toml", {"solver.effort=draft"});
  SceneRun elastic("dented_can.toml", {"solver.effort=draft", "body.0.material.yield_strain=10"});
  const double wall = can.probe("front").z();
  for (SceneRun* run : {&can, &elastic}) {
    run->until_frame(9);
    EXPECT_LT(run->probe("front").z(), wall - 0.015) << "pressed in";
    run->until_frame(20);
  }
  EXPECT_LT(can.probe("front").z(), wall - 0.01);
  EXPECT_GT(elastic.probe("front").z(), wall - 0.002);
}

}  // namespace
}  // namespace muslin::test
