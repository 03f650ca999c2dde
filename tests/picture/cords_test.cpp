// Cords of a run: tubes between the points that an attachment holds, as long as it holds them.
#include "muslin/picture/cords.hpp"

#include <memory>
#include <string>

#include "cache/scratch.hpp"
#include <gtest/gtest.h>

#include "muslin/cache/run_writer.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

constexpr double radius = 0.003;

/// Runs 12 frames of a ball of radius 0.05 m, 0.2 m below a post, on a cord from (0, 0.35, 0) to
/// (0, 0.55, 0).
RunReader run(const test::Scratch& scratch, const std::string& of_ball, const std::string& of_cord) {
  const Scene scene = parse_scene(R"([time]
duration = 0.5
[[collider]]
name = 'ball'
shape = 'sphere'
center = [0, 0.3, 0]
radius = 0.05
density = 20
)" + of_ball + R"(
[[collider]]
name = 'post'
shape = 'box'
size = [0.1, 0.1, 0.1]
center = [0, 0.6, 0]
[[force]]
type = 'gravity'
[[attachment]]
name = 'a b'
body = 'ball'
where = { nearest = [0, 0.35, 0] }
to = 'post'
rest = 'cord'
)" + of_cord,
                                  scratch.path() / "scene.toml");
  Simulation simulation(std::make_shared<const Model>(build_model(scene)));
  RunWriter writer(scratch / "run", simulation, 12, false);
  while (simulation.frame() < 12) {
    simulation.advance();
    writer.write_frame();
  }
  return RunReader(scratch / "run");
}

Vec3 middle(const std::vector<Vec3>& points, std::size_t ring) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 8; ++k) sum += points[8 * ring + k];
  return sum / 8;
}

double length(const std::vector<Vec3>& points) {
  double sum = 0;
  for (std::size_t ring = 1; ring < 17; ++ring)
    sum += (middle(points, ring) - middle(points, ring - 1)).norm();
  return sum;
}

TEST(Cords, RunFromPointToPoint) {
  const test::Scratch scratch;
  const RunReader reader = run(scratch, "", "");
  const Cords cords(reader, radius);
  for (const int frame : {0, 12}) {
    const std::vector<Vec3> points = cords.points(frame);
    ASSERT_EQ(points.size(), 17u * 8);
    EXPECT_NEAR(middle(points, 0).y(), 0.35, 1e-4) << "it carries the ball";
    EXPECT_NEAR(middle(points, 16).y(), 0.55, 1e-6);
    EXPECT_NEAR((points[0] - middle(points, 0)).norm(), radius, 1e-6);
  }
  for (const Vec3i& triangle : cords.surface().triangles) EXPECT_LT(triangle.maxCoeff(), 17 * 8);
}

TEST(Cords, SagWhenTheyAreSlack) {
  const test::Scratch scratch;
  const RunReader reader = run(scratch, "velocity = [0, 1, 0]", "");
  const std::vector<Vec3> points = Cords(reader, radius).points(2);
  const double apart = (middle(points, 0) - middle(points, 16)).norm();
  const double time = 2.0 / 24;
  EXPECT_NEAR(apart, 0.2 - time + 4.9 * time * time, 2e-3) << "the ball is thrown up";
  EXPECT_NEAR(length(points), 0.2, 1e-3) << "the length of the cord";
}

TEST(Cords, AreDrawnWhileTheyHold) {
  const auto extents = [](const std::string& of_cord) {
    const test::Scratch scratch;
    const RunReader reader = run(scratch, "", of_cord);
    const Cords cords(reader, radius);
    std::vector<bool> drawn;
    for (int frame = 0; frame <= 12; ++frame) drawn.push_back(length(cords.points(frame)) > 0.1);
    return drawn;
  };
  const std::vector<bool> broken = extents("break_force = 0.01\n");
  EXPECT_TRUE(broken.front());
  EXPECT_FALSE(broken.back()) << "it cannot carry the ball";
  const std::vector<bool> for_a_while = extents("from = 0.125\nuntil = 0.25\n");
  for (const int frame : {0, 2, 7, 12}) EXPECT_FALSE(for_a_while[static_cast<std::size_t>(frame)]) << frame;
  for (const int frame : {3, 5}) EXPECT_TRUE(for_a_while[static_cast<std::size_t>(frame)]) << frame;
}

}  // namespace
}  // namespace muslin
