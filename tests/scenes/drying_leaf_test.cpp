// The drying leaf: flat at first, it curls because its margin gets shorter than its midrib.
#include <cmath>
#include <utility>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

/// How far the margin stands above or below the midrib in the middle of the blade, and the width there [m].
std::pair<double, double> shape(const SceneRun& run) {
  const Vec3 middle =
      run.mean([](const Vec3& rest) { return std::abs(rest.x() - 0.0375) < 0.001 && rest.z() == 0; });
  const Vec3 left = run.probe("left"), right = run.probe("right");
  return {((left + right) / 2 - middle).norm(), (left - right).norm()};
}

TEST(DryingLeaf, CurlsWhereItsMarginShrinks) {
  SceneRun run("drying_leaf.toml", {"solver.effort=draft"});
  const auto [flat, wide] = shape(run);
  EXPECT_LT(flat, 1e-3);
  run.until_frame(36);
  const auto [curled, narrow] = shape(run);
  EXPECT_GT(curled, 0.009);
  EXPECT_LT(narrow, 0.88 * wide);
  EXPECT_GT(run.simulation().diagnostics().material_work, 0) << "drying works on the leaf";
}

}  // namespace
}  // namespace muslin::test
