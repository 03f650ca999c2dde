// The rubber bear: it follows the hand that pulls it, and narrows as a solid with its Poisson's ratio does.
#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

TEST(StretchedBear, IsPulledUpAndNarrows) {
  SceneRun run("stretched_bear.toml", {"solver.effort=draft"});
  const auto waist = [](const Vec3& rest) { return rest.y() > 0.025 && rest.y() < 0.035; };
  const auto width = [&] {
    double least = 1, most = -1;
    for (std::size_t v = 0; v < run.rest().size(); ++v) {
      if (!waist(run.rest()[v])) continue;
      least = std::min(least, run.now()[v].x());
      most = std::max(most, run.now()[v].x());
    }
    return most - least;
  };
  const double before = width(), height = run.probe("head").y();
  run.until_frame(17);  // 0.71 s: the head is 5 cm up
  EXPECT_NEAR(run.probe("head").y() - height, 0.05, 0.005);
  EXPECT_LT(width(), 0.95 * before);
  EXPECT_GT(run.simulation().diagnostics().max_stretch, 1.3);
}

}  // namespace
}  // namespace muslin::test
