// The cushion: it fills up, carries what lies on it, and nothing crosses.
#include "support/scene_run.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/contact/crossings.hpp"

namespace muslin::test {
namespace {

double volume(const SceneRun& run) {
  double six = 0;
  for (const Vec3i& t : triangulate(run.body().mesh).triangles) {
    const auto at = [&](int k) { return run.now()[static_cast<std::size_t>(t[k])]; };
    six += at(0).dot(at(1).cross(at(2)));
  }
  return six / 6;
}

TEST(Cushion, InflatesUnderTheBallWithoutCrossings) {
  SceneRun run("cushion.toml", {"solver.effort=draft"});
  const double before = volume(run);
  run.until_frame(18);
  EXPECT_GT(volume(run), 2 * before);
  // The pump works against the weights of cushion and ball.
  EXPECT_GT(run.simulation().diagnostics().work, 0);
  EXPECT_TRUE(find_crossings(*run.model().contact, run.now()).empty());
  EXPECT_LT(run.simulation().diagnostics().max_stretch, 1.05);
}

}  // namespace
}  // namespace muslin::test
