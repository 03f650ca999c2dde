// The leaf, the nylon flag and the jelly bear: what must be so whatever the numbers of the scene. Voxels are
// coarser than in the scenes where something moves, so that the tests are quick.
#include <cmath>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

bool all_finite(const std::vector<Vec3>& points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); });
}

TEST(Leaf, KeepsItsOutlineAtRest) {
  const SceneRun run("leaf.toml");
  const BodyStatistics& leaf = run.body().statistics;
  EXPECT_EQ(run.lattice_body().contour.method, ContourMethod::squares);
  EXPECT_LT(leaf.contour_distance, 0.5 * run.lattice_body().lattice.width);
  EXPECT_EQ(leaf.coverage, 1);
}

TEST(Leaf, BladeMovesAndStemIsHeld) {
  SceneRun run("leaf.toml", {"body.leaf.voxel_width=0.004"});
  const Vec3 tip = run.probe("tip");
  run.until_frame(6);
  EXPECT_TRUE(run.held_are_still("stem"));
  EXPECT_TRUE(all_finite(run.now()));
  EXPECT_GT((run.probe("tip") - tip).norm(), 0.002);
  EXPECT_LT((run.probe("tip") - tip).norm(), 0.2);
  EXPECT_LT(run.simulation().diagnostics().max_stretch, 1.5);
}

double free_edge(const std::vector<std::string>& overrides, int frames) {
  SceneRun run("nylon_flag.toml", overrides);
  run.until_frame(frames);
  EXPECT_TRUE(run.held_are_still("pole"));
  // The threads hardly stretch, but a square sheared flat has diagonals 1.414 times as long.
  EXPECT_LT(run.simulation().diagnostics().max_stretch, 1.45);
  return run.mean([](const Vec3& x) { return x.x() > 1.4; }).x();
}

TEST(NylonFlag, StreamsDownwind) {
  const std::string coarse = "body.flag.voxel_width=0.15", quick = "time.steps_per_frame=5";
  EXPECT_GT(free_edge({coarse, quick}, 18), 1.0);
  EXPECT_LT(free_edge({coarse, quick, "force.1.velocity=[-7, 0, -1.5]"}, 18), -0.5);
}

TEST(JellyBear, DeformsAndRecovers) {
  SceneRun run("jelly_bear.toml", {"body.bear.voxel_width=0.007", "time.steps_per_frame=3"});
  double farthest = 0;
  for (int frame = 1; frame <= 44; ++frame) {
    run.until_frame(frame);
    const Diagnostics& now = run.simulation().diagnostics();
    ASSERT_NEAR(run.volume_ratio(), 1, 0.02) << "frame " << frame;
    ASSERT_LT(now.max_stretch, 1.5) << "frame " << frame;
    farthest = std::max(farthest, std::abs(run.probe("head").x()));
  }
  EXPECT_GT(farthest, 0.005);  // the plate moves by 15 mm
  EXPECT_LT(std::abs(run.probe("head").x()), 0.005);
  EXPECT_GT(run.probe("head").y(), 0.065);  // 73 mm at rest
}

}  // namespace
}  // namespace muslin::test
