#include "muslin/geometry/thicken.hpp"

#include <cmath>

#include "geometry/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/geometry/orientation.hpp"

namespace muslin {
using shapes::volume;

namespace {

// Every edge is run once each way by the same number of faces.
bool closed_and_consistent(const Mesh& mesh) {
  bool good = true;
  for_each_edge(edge_uses(mesh), [&](std::span<const EdgeUse> edge) {
    int balance = 0;
    for (const EdgeUse& use : edge) balance += use.ascends ? 1 : -1;
    good = good && balance == 0;
  });
  return good;
}

const auto all = [](std::size_t) { return true; };
const auto none = [](std::size_t) { return false; };

TEST(IsClosed, DistinguishesOpenAndClosedMeshes) {
  EXPECT_TRUE(is_closed(shapes::box(Vec3::Zero(), Vec3::Ones())));
  EXPECT_TRUE(is_closed(shapes::sphere(1, 1)));
  EXPECT_FALSE(is_closed(shapes::rectangle(1, 1)));
  EXPECT_FALSE(is_closed(shapes::selected(shapes::sphere(1, 1), [](std::size_t f) { return f != 0; }, none)));
  EXPECT_FALSE(is_closed(Mesh{}));
}

TEST(Thicken, AFlatRectangleBecomesExactlyABox) {
  for (const auto& [nx, ny] : {std::pair{1, 1}, {10, 6}}) {
    const Mesh solid = thicken(shapes::rectangle(10, 6, nx, ny), 0.3);
    EXPECT_TRUE(closed_and_consistent(solid));
    EXPECT_EQ(solid.bounds().min(), Vec3(0, 0, -0.15));
    EXPECT_EQ(solid.bounds().max(), Vec3(10, 6, 0.15));
    EXPECT_NEAR(volume(solid), 18, 1e-12);
    for (const Vec3& p : solid.positions) EXPECT_EQ(std::abs(p.z()), 0.15);
  }
}

TEST(Thicken, SidesAndWallsHaveTheMaterialOfTheirFace) {
  Mesh sheet = shapes::rectangle(2, 1, 2, 1);
  sheet.materials = {{"blue", {0}}, {"red", {1}}};
  const Mesh solid = thicken(sheet, 0.1);
  ASSERT_EQ(solid.materials.size(), 2U);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_EQ(solid.materials[m].faces.size(), 5U) << "two sides and three walls";
    for (const int f : solid.materials[m].faces)
      for (const int v : solid.face(static_cast<std::size_t>(f)))
        EXPECT_LE(std::abs(solid.positions[static_cast<std::size_t>(v)].x() - (m == 0 ? 0.5 : 1.5)), 0.5);
  }
}

TEST(Thicken, FlippedSheetGivesTheSameSolid) {
  const Mesh flag = shapes::rectangle(10, 6, 5, 3);
  EXPECT_NEAR(volume(thicken(shapes::selected(flag, all, all), 0.2)), 12, 1e-12);
  const Mesh mixed = shapes::selected(flag, all, [](std::size_t f) { return f % 2 == 0; });
  EXPECT_TRUE(closed_and_consistent(thicken(mixed, 0.2)));
  EXPECT_NEAR(volume(thicken(mixed, 0.2)), 12, 1e-12);
}

TEST(Thicken, FacesOfAFoldMoveByHalfTheThickness) {
  // Two squares at a right angle along the y axis.
  const Mesh fold = shapes::from({{1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}},
                                 {{0, 1, 3, 2}, {2, 3, 5, 4}});
  const Mesh solid = thicken(fold, 0.2);
  EXPECT_TRUE(closed_and_consistent(solid));
  // 0.2 × (outer + inner length)/2 × 1, mitred: both legs 1 along the middle line.
  EXPECT_NEAR(volume(solid), 0.4, 1e-12);
  EXPECT_NEAR(solid.bounds().min().x(), -0.1, 1e-12);
  EXPECT_NEAR(solid.bounds().min().z(), -0.1, 1e-12);
}

TEST(Thicken, ASphereBecomesAShell) {
  const Mesh shell = thicken(shapes::sphere(1, 4), 0.1);
  EXPECT_TRUE(closed_and_consistent(shell));
  const double exact = 4.0 / 3 * EIGEN_PI * (std::pow(1.05, 3) - std::pow(0.95, 3));
  EXPECT_NEAR(volume(shell), exact, 0.01 * exact);
}

TEST(Thicken, AHemisphereIsClosedAlongItsRim) {
  Mesh sphere = shapes::sphere(1, 4);
  const Mesh bowl = shapes::selected(
      sphere,
      [&](std::size_t f) {
        Vec3 sum = Vec3::Zero();
        for (const int v : sphere.face(f)) sum += sphere.positions[static_cast<std::size_t>(v)];
        return sum.z() > 0;
      },
      none);
  const Mesh solid = thicken(bowl, 0.1);
  EXPECT_TRUE(closed_and_consistent(solid));
  const double exact = 2.0 / 3 * EIGEN_PI * (std::pow(1.05, 3) - std::pow(0.95, 3));
  EXPECT_NEAR(volume(solid), exact, 0.01 * exact);
}

TEST(Thicken, SheetsThatShareAnEdgeGetSeparateSlabs) {
  const Mesh fan =
      shapes::from({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {0, 0, 1}, {0, 1, 1}},
                   {{0, 2, 3, 1}, {0, 1, 5, 4}, {0, 1, 7, 6}});
  const Mesh solid = thicken(fan, 0.1);
  EXPECT_TRUE(closed_and_consistent(solid));
  EXPECT_NEAR(volume(solid), 0.3, 1e-12);
}

TEST(Thicken, SoupBecomesSlabs) {
  const Mesh soup = shapes::joined(shapes::rectangle(1, 1), shapes::sphere(1, 1, Vec3(5, 0, 0)));
  Mesh loose;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    std::vector<int> face;
    for (const int v : soup.face(f)) {
      face.push_back(static_cast<int>(loose.positions.size()));
      loose.positions.push_back(soup.positions[static_cast<std::size_t>(v)]);
    }
    loose.add_face(face);
  }
  const Mesh solid = thicken(loose, 0.01);
  EXPECT_TRUE(closed_and_consistent(solid));
  EXPECT_GT(volume(solid), 0);
}

TEST(Thicken, SurvivesFacesWithoutArea) {
  const Mesh mesh = shapes::from({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}},
                                 {{0, 1, 2, 3}, {1, 4, 1}, {0, 1, 4}});
  const Mesh solid = thicken(mesh, 0.1);
  EXPECT_TRUE(closed_and_consistent(solid));
  for (const Vec3& p : solid.positions) EXPECT_TRUE(p.allFinite());
}

TEST(Thicken, RejectsInvalidThickness) {
  const Mesh flag = shapes::rectangle(1, 1);
  for (const double thickness : {0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_THROW(thicken(flag, thickness), Error);
}

}  // namespace
}  // namespace muslin
