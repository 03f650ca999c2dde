// The tied cushion: it fills up, its corners draw in and rise until the cords hold them, and nothing crosses.
#include <cmath>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"

namespace muslin::test {
namespace {

TEST(TiedCushion, IsHeldAtItsCornersByTautCords) {
  SceneRun run("tied_cushion.toml", {"solver.effort=draft"});
  const Vec3 corner = run.probe("corner");
  run.until_frame(36);
  EXPECT_GT(run.probe("top").y(), 0.11);
  EXPECT_LT(run.probe("corner").x(), corner.x() - 0.001);
  EXPECT_NEAR(run.probe("corner").x(), run.probe("corner").z(), 1e-3) << "it stays symmetric";
  for (const char* cord : {"north west", "north east", "south west", "south east"})
    EXPECT_GT(run.simulation().attachment_force(cord).sum.norm(), 1) << cord;
  EXPECT_TRUE(find_crossings(*run.model().contact, run.now()).empty());
}

}  // namespace
}  // namespace muslin::test
