#include "muslin/post/carried_mesh.hpp"

#include <cmath>
#include <numbers>

#include "geometry/shapes.hpp"
#include <gmock/gmock.h>

#include "muslin/contact/intersections.hpp"
#include "muslin/core/error.hpp"

namespace muslin {
namespace {

/// Bends the plane z = 0 around an axis along y: a cylinder of this radius, heights along its normal.
std::vector<Vec3> rolled(ConstVectors points, double radius) {
  std::vector<Vec3> result;
  for (const Vec3& x : points) {
    const double angle = x.x() / radius, r = radius - x.z();
    result.emplace_back(r * std::sin(angle), x.y(), radius - r * std::cos(angle));
  }
  return result;
}

Mesh raised(Mesh mesh, double height) {
  for (Vec3& x : mesh.positions) x.z() += height;
  return mesh;
}

TEST(CarriedMesh, LiesAtRestWhereItWasModelled) {
  const Mesh coarse = shapes::sphere(1, 2);
  Mesh fine = shapes::sphere(1.1, 3, Vec3(0.02, 0, 0));
  const Carried carried = CarriedMesh(coarse, fine).points(coarse.positions);
  ASSERT_EQ(carried.points.size(), fine.vertex_count());
  for (std::size_t v = 0; v < fine.vertex_count(); ++v)
    EXPECT_NEAR((carried.points[v] - fine.positions[v]).norm(), 0, 1e-12);
  EXPECT_EQ(carried.crossings, 0U);
  EXPECT_EQ(carried.drawn_in, 0U);
}

TEST(CarriedMesh, MovesRigidlyWithTheSurfaceAlsoBeyondItsBorder) {
  const Mesh coarse = shapes::rectangle(1, 1, 4, 4);
  Mesh fine = raised(shapes::rectangle(1.2, 1.2, 9, 9), 0.05);  // a tenth beyond the border on two sides
  const Eigen::Affine3d motion =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(2, Vec3(1, 2, 3).normalized());
  std::vector<Vec3> moved = coarse.positions;
  for (Vec3& x : moved) x = motion * x;
  const Carried carried = CarriedMesh(coarse, fine).points(moved);
  for (std::size_t v = 0; v < fine.vertex_count(); ++v)
    EXPECT_NEAR((carried.points[v] - motion * fine.positions[v]).norm(), 0, 1e-12);
}

TEST(CarriedMesh, KeepsItsDistanceFromABentSurface) {
  const double radius = 0.5;
  const Mesh coarse = shapes::rectangle(1, 0.5, 40, 20);
  const Mesh fine = raised(shapes::rectangle(1, 0.5, 87, 41), 0.03);
  const Carried carried = CarriedMesh(coarse, fine).points(rolled(coarse.positions, radius));
  const std::vector<Vec3> exact = rolled(fine.positions, radius);
  double worst = 0;
  for (std::size_t v = 0; v < fine.vertex_count(); ++v)
    worst = std::max(worst, (carried.points[v] - exact[v]).norm());
  EXPECT_LT(worst, 1.2e-3);  // half a coarse edge: sagitta 0.16 mm; normals at the border: 25 mrad of 30 mm
}

TEST(CarriedMesh, DoesNotCrossItselfInANarrowFold) {
  // The offsets are longer than the fold is wide: whole, they would turn the mesh inside out.
  const Mesh coarse = shapes::rectangle(1, 0.5, 60, 20);
  const Mesh fine = raised(shapes::rectangle(1, 0.5, 80, 31), 0.1);
  const CarriedMesh mesh(coarse, fine);
  std::vector<Vec3> folded = coarse.positions;  // a hairpin at x = 0.7 with a gap of 40 mm
  const double radius = 0.02, turn = std::numbers::pi * radius;
  for (Vec3& x : folded) {
    const double s = x.x() - 0.7;
    if (s < 0) {
      x.z() = 0;
    } else if (s < turn) {
      x = Vec3(0.7 + radius * std::sin(s / radius), x.y(), radius - radius * std::cos(s / radius));
    } else {
      x = Vec3(0.7 - (s - turn), x.y(), 2 * radius);
    }
  }
  const Carried carried = mesh.points(folded);
  EXPECT_GT(carried.drawn_in, 100U);
  EXPECT_LT(carried.drawn_in, fine.vertex_count());
  EXPECT_EQ(carried.crossings, 0U);
  EXPECT_TRUE(find_intersections(carried.points, triangulate(fine).triangles).empty());
  // The lower layer stays below the middle of the gap, and keeps its offset where no other layer is near.
  for (std::size_t v = 0; v < fine.vertex_count(); ++v) {
    const double x = fine.positions[v].x();
    if (x > 0.55 && x < 0.65) {
      EXPECT_LT(carried.points[v].z(), radius) << v;
    }
    if (x < 0.3) {
      EXPECT_NEAR(carried.points[v].z(), 0.1, 1e-12) << v;
    }
  }
}

TEST(CarriedMesh, DoesNotCrossAnObstacle) {
  const Mesh coarse = shapes::rectangle(1, 1, 10, 10);
  const Mesh fine = raised(shapes::rectangle(1, 1, 20, 20), 0.1);
  const Mesh ball = shapes::sphere(0.2, 2, Vec3(0.5, 0.5, 0.25));  // 50 mm above the sheet, 50 mm in the mesh
  const Obstacles obstacles{ball.positions, triangulate(ball).triangles};
  const Carried carried = CarriedMesh(coarse, fine).points(coarse.positions, obstacles);
  EXPECT_EQ(carried.crossings, 0U);
  EXPECT_GT(carried.drawn_in, 0U);
  EXPECT_LT(carried.drawn_in, fine.vertex_count() / 2);
  // A ball that goes through the sheet itself stays crossed, and its crossings are counted.
  const Mesh through = shapes::sphere(0.2, 2, Vec3(0.5, 0.5, 0));
  EXPECT_GT(CarriedMesh(coarse, fine)
                .points(coarse.positions, {through.positions, triangulate(through).triangles})
                .crossings,
            0U);
}

TEST(CarriedMesh, LeavesCrossingsAsTheyWereModelled) {
  // A fin through the sheet's upper side, as of a badge that is stuck through cloth.
  const Mesh coarse = shapes::rectangle(1, 1, 10, 10);
  Mesh fin = shapes::rectangle(0.2, 0.1, 2, 2);
  for (Vec3& x : fin.positions) x = Vec3(0.41 + x.x(), 0.52, x.y());
  const Mesh fine = shapes::joined(raised(coarse, 0.03), fin);
  ASSERT_FALSE(find_intersections(fine.positions, triangulate(fine).triangles).empty());
  const Carried carried = CarriedMesh(coarse, fine).points(coarse.positions);
  EXPECT_EQ(carried.crossings, 0U);
  EXPECT_EQ(carried.drawn_in, 0U);
}

TEST(CarriedMesh, RefusesAMeshInAnotherPlace) {
  const Mesh coarse = shapes::rectangle(1, 1, 4, 4);
  try {
    const CarriedMesh far(coarse, raised(coarse, 100));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.problem(), testing::HasSubstr("is 100 m from the surface"));
    EXPECT_THAT(error.remedy(), testing::HasSubstr("same place"));
  }
  EXPECT_THROW(CarriedMesh({}, coarse), Error);
  Mesh small = coarse;
  for (Vec3& x : small.positions) x *= 1e-3;
  EXPECT_THROW(CarriedMesh(coarse, small), Error);
}

}  // namespace
}  // namespace muslin
