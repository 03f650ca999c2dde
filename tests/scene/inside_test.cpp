// `inside` of a lattice: what a mesh bounds may be forced, and unclean solids fill in a moment.
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {
namespace {

/// Adds the lower half of a sphere, open above.
void add_bowl(Mesh& mesh, const Vec3& centre, double radius) {
  constexpr int around = 20, rings = 7;
  const int first = static_cast<int>(mesh.positions.size());
  mesh.positions.push_back(centre - radius * Vec3::UnitY());
  for (int r = 1; r <= rings; ++r) {
    for (int a = 0; a < around; ++a) {
      const double theta = std::numbers::pi / 2 * r / rings, phi = 2 * std::numbers::pi * a / around;
      mesh.positions.push_back(centre + radius * Vec3(std::sin(theta) * std::cos(phi), -std::cos(theta),
                                                      std::sin(theta) * std::sin(phi)));
    }
  }
  const auto at = [&](int r, int a) { return first + 1 + (r - 1) * around + a % around; };
  for (int a = 0; a < around; ++a) {
    mesh.add_face(std::array{first, at(1, a), at(1, a + 1)});
    for (int r = 1; r < rings; ++r)
      mesh.add_face(std::array{at(r, a), at(r + 1, a), at(r + 1, a + 1), at(r, a + 1)});
  }
}

Model build(const Mesh& mesh, const std::string& keys) {
  Scene scene =
      parse_scene("[[body]]\nname = 'b'\nmesh = 'mesh'\nmaterial = 'rubber'\n" + keys, "scene.toml");
  scene.meshes["mesh"] = std::make_shared<const Mesh>(mesh);
  return build_model(scene);
}

double volume(const Model& model) {
  const Lattice& lattice = as_lattice(model.bodies.front())->lattice;
  double sum = 0;
  for (const double fill : lattice.fill) sum += fill;
  return sum * std::pow(lattice.width, 3);
}

TEST(Inside, ABowlIsASheetUnlessItIsFilled) {
  Mesh bowl;
  add_bowl(bowl, Vec3::Zero(), 1);
  const Model sheet = build(bowl, "voxel_width = 0.1\n"),
              solid = build(bowl, "voxel_width = 0.1\ninside = 'filled'\n");
  EXPECT_TRUE(as_lattice(sheet.bodies.front())->sheet);
  EXPECT_THAT(sheet.warnings, testing::Contains(testing::HasSubstr("inside = \"filled\"")));
  EXPECT_FALSE(as_lattice(solid.bodies.front())->sheet);
  // The winding number of a hemisphere is above one half below its rim.
  EXPECT_NEAR(volume(solid), 2 * std::numbers::pi / 3, 0.15);
}

TEST(Inside, AClosedMeshMayBeASheet) {
  Mesh ball;
  add_bowl(ball, Vec3::Zero(), 1);
  const std::size_t half = ball.positions.size();
  add_bowl(ball, Vec3::Zero(), 1);
  for (std::size_t v = half; v < ball.positions.size(); ++v) ball.positions[v].y() *= -1;
  const Model filled = build(ball, "voxel_width = 0.1\ninside = 'filled'\n"),
              hollow = build(ball, "voxel_width = 0.1\ninside = 'sheet'\nthickness = 0.1\n");
  EXPECT_NEAR(volume(filled), 4 * std::numbers::pi / 3, 0.15);
  EXPECT_NEAR(volume(hollow), 4 * std::numbers::pi * 0.1, 0.1);
}

TEST(Inside, OverlappingBowlsFillInAMoment) {
  Mesh bowls;
  for (int i = 0; i < 12; ++i)
    add_bowl(bowls, Vec3(0.3 * std::sin(2.0 * i), 0.2 * std::sin(3.0 * i), 0.3 * std::cos(5.0 * i)), 0.3);
  const auto begin = std::chrono::steady_clock::now();
  const Model model = build(bowls, "voxel_width = 0.06\n");
  EXPECT_LT(std::chrono::steady_clock::now() - begin,
            std::chrono::seconds(30));
  EXPECT_GT(volume(model), 0.05);
}

}  // namespace
}  // namespace muslin
