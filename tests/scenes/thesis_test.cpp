// The eight experiments of Thanh Ho, "Cloth - Modeling, Deformation, and Simulation", CSUSB 2016: what its
// figures show, as facts.
#include <array>
#include <cmath>
#include <map>

#include "support/scene_run.hpp"
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

bool near_to(double a, double b) { return std::abs(a - b) < 1e-9; }

TEST(Thesis1Rest, NothingMoves) {
  SceneRun run("thesis/1_rest.toml");
  run.until_frame(12);
  EXPECT_EQ(run.now(), run.rest());
  EXPECT_EQ(run.simulation().diagnostics().kinetic, 0);
  EXPECT_EQ(run.simulation().diagnostics().elastic, 0);
}

TEST(Thesis2TwoCorners, MiddleOfTheLowerEdgeHangsLowest) {
  SceneRun run("thesis/2_two_corners.toml");
  run.until_frame(24);
  EXPECT_TRUE(run.held_are_still());
  const Vec3 lowest = run.rest_of_lowest();
  EXPECT_NEAR(lowest.x(), 5, 1.01);
  EXPECT_NEAR(lowest.y(), 0, 1e-9);
  EXPECT_LT(run.probe("middle of the lower edge").y(), -2);
}

TEST(Thesis2TwoCorners, SkinAndContourFallTogether) {
  SceneRun run("thesis/2_two_corners.toml");
  run.until_frame(24);
  const LatticeBody& body = run.lattice_body();
  const auto mean = [&](const Embedding& embedding) {
    std::vector<Vec3> points(embedding.size());
    embedding.apply(run.now(), points);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : points) sum += p;
    return Vec3(sum / static_cast<double>(points.size()));
  };
  EXPECT_LT((mean(body.skin) - mean(body.contour.embedding)).norm(),
            0.2);                       // they place their points differently
  EXPECT_LT(mean(body.skin).y(), 2.5);  // 3 at rest
}

TEST(Thesis3CentreBlown, LeftEdgeMovesAlongTheForce) {
  SceneRun run("thesis/3_centre_blown.toml");
  run.until_frame(24);
  EXPECT_TRUE(run.held_are_still());
  const Vec3 left = run.mean([](const Vec3& x) { return near_to(x.x(), 0); });
  const Vec3 right = run.mean([](const Vec3& x) { return near_to(x.x(), 10); });
  EXPECT_GT(left.x(), 0);                   // blown to the right
  EXPECT_GT(left.x() - 0, 10 - right.x());  // farther in than the other edge
  EXPECT_LT(left.y(), -1);                  // and down
  EXPECT_LT(left.y(), right.y());
}

TEST(Thesis4LeftEdge, FreeSideHangsLowest) {
  SceneRun run("thesis/4_left_edge.toml");
  run.until_frame(24);
  EXPECT_TRUE(run.held_are_still());
  EXPECT_GT(run.rest_of_lowest().x(), 5);
  EXPECT_NEAR(run.rest_of_lowest().y(), 0, 1e-9);
  EXPECT_LT(run.probe("lower right corner").y(), -3);
  EXPECT_LT(run.probe("upper right corner").y(), 3);
}

TEST(Thesis5HorizontalPole, CornersFallWhenReleased) {
  SceneRun run("thesis/5_horizontal_pole.toml");
  run.until_frame(23);
  EXPECT_TRUE(run.held_are_still());
  run.until_frame(42);
  EXPECT_TRUE(run.held_are_still("pole"));
  for (const double z : {0.0, 6.0}) {
    const Vec3 corner = run.mean([z](const Vec3& x) { return near_to(x.x(), 10) && near_to(x.z(), z); });
    EXPECT_LT(corner.y(), -2) << z;
  }
  EXPECT_GT(run.rest_of_lowest().x(), 5);
}

TEST(Thesis6Lifted, IsHigherThanWithoutTheLift) {
  SceneRun plain("thesis/5_horizontal_pole.toml"), lifted("thesis/6_horizontal_pole_lifted.toml");
  const auto everything = [](const Vec3&) { return true; };
  for (const int frame : {8, 16}) {
    plain.until_frame(frame);
    lifted.until_frame(frame);
    EXPECT_GT(lifted.mean(everything).y(), plain.mean(everything).y()) << frame;
    EXPECT_TRUE(lifted.held_are_still());
  }
  lifted.until_frame(42);
  EXPECT_TRUE(lifted.held_are_still("pole"));
  const Vec3 corner = lifted.mean([](const Vec3& x) { return near_to(x.x(), 10) && near_to(x.z(), 0); });
  EXPECT_LT(corner.y(), -1);
}

TEST(Thesis7Ball, CentreSinksBetweenFixedCorners) {
  SceneRun run("thesis/7_ball.toml");
  run.until_frame(24);
  EXPECT_TRUE(run.held_are_still());
  EXPECT_LT(run.probe("centre").y(), -0.5);
  const Vec3 lowest = run.rest_of_lowest();
  EXPECT_NEAR(lowest.x(), 5, 1e-9);
  EXPECT_NEAR(lowest.z(), 3, 1e-9);
}

TEST(Thesis7Ball, HasTheSymmetryOfItsBracing) {
  SceneRun run("thesis/7_ball.toml", {"body.flag.bracing=full", "solver.tolerance=1e-9"});
  run.until_frame(18);
  EXPECT_LT(run.probe("centre").y(), -0.1);
  const auto key = [](const Vec3& x) {
    return std::array{std::lround(4 * x.x()), std::lround(4 * x.y()), std::lround(4 * x.z())};
  };
  std::map<std::array<long, 3>, std::size_t> at;
  for (std::size_t v = 0; v < run.rest().size(); ++v) at[key(run.rest()[v])] = v;
  for (std::size_t v = 0; v < run.rest().size(); ++v) {
    const Vec3 x = run.rest()[v], u = run.now()[v];
    const Vec3 in_x = run.now()[at.at(key({10 - x.x(), x.y(), x.z()}))];
    const Vec3 in_z = run.now()[at.at(key({x.x(), x.y(), 6 - x.z()}))];
    ASSERT_LT((Vec3(10 - in_x.x(), in_x.y(), in_x.z()) - u).norm(), 1e-6) << x.transpose();
    ASSERT_LT((Vec3(in_z.x(), in_z.y(), 6 - in_z.z()) - u).norm(), 1e-6) << x.transpose();
  }
}

TEST(Thesis8CentreOnAPole, CornersHangLowest) {
  SceneRun run("thesis/8_centre_on_a_pole.toml");
  run.until_frame(30);
  EXPECT_TRUE(run.held_are_still());
  const Vec3 lowest = run.rest_of_lowest();
  EXPECT_NEAR(std::abs(lowest.x() - 5), 5, 1e-9);
  EXPECT_NEAR(std::abs(lowest.z() - 3), 3, 1e-9);
  EXPECT_LT(run.probe("corner").y(), run.probe("middle of the long edge").y());
}

}  // namespace
}  // namespace muslin::test
