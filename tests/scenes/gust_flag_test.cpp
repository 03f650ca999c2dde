// The flag in gusts: its worn end is lighter than the rest, tears apart into tatters that swing more than the
// middle, and stays on the pole.
#include <algorithm>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

TEST(GustFlag, SwingsMostAtItsTornThinEnd) {
  SceneRun run("gust_flag.toml");
  const double area = 1.5 * 0.9;
  EXPECT_LT(run.body().statistics.mass, 0.14 * area) << "torn, and worn thin";
  EXPECT_GT(run.body().statistics.mass, 0.06 * area);
  double middle[2] = {1e9, -1e9}, tatter[2] = {1e9, -1e9};
  for (int frame = 4; frame <= 16; ++frame) {
    run.until_frame(frame);
    const double m = run.probe("middle").z(), t = run.probe("tatter").z();
    middle[0] = std::min(middle[0], m), middle[1] = std::max(middle[1], m);
    tatter[0] = std::min(tatter[0], t), tatter[1] = std::max(tatter[1], t);
  }
  EXPECT_GT(tatter[1] - tatter[0], middle[1] - middle[0]);
  EXPECT_GT(run.probe("tatter").x(), 0.9) << "it streams from the pole";
}

}  // namespace
}  // namespace muslin::test
