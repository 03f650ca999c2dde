#include "muslin/geometry/winding_number.hpp"

#include <cmath>
#include <numbers>

#include "geometry/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

double brute_force(const Mesh& mesh, const std::vector<Vec3i>& triangles, const Vec3& p) {
  double sum = 0;
  for (const Vec3i& t : triangles)
    sum += solid_angle(mesh.positions[static_cast<std::size_t>(t.x())] - p,
                       mesh.positions[static_cast<std::size_t>(t.y())] - p,
                       mesh.positions[static_cast<std::size_t>(t.z())] - p);
  return sum / (4 * std::numbers::pi);
}

double largest_error(const Mesh& mesh, double share) {
  const std::vector<Vec3i> triangles = triangulate(mesh).triangles;
  const WindingNumber winding(mesh.positions, triangles);
  double largest = 0;
  for (const Vec3& p : shapes::points_around(mesh.bounds(), 1000, share))
    largest = std::max(largest, std::abs(winding(p) - brute_force(mesh, triangles, p)));
  return largest;
}

TEST(SolidAngle, OfAnOctantIsAnEighthOfTheSphere) {
  EXPECT_NEAR(solid_angle(Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()), std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(solid_angle(Vec3::UnitX(), Vec3::UnitZ(), Vec3::UnitY()), -std::numbers::pi / 2, 1e-15);
}

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
  const Mesh mesh = shapes::sphere(1, 4);
  const WindingNumber winding(mesh.positions, triangulate(mesh).triangles);
  for (const Vec3& p : shapes::points_around(mesh.bounds(), 1000, 0.3))
    if (std::abs(p.norm() - 1) > 0.01) {
      EXPECT_NEAR(winding(p), p.norm() < 1 ? 1 : 0, 4e-3) << p.transpose();
    }
}

TEST(WindingNumber, AgreesWithBruteForce) {
  EXPECT_LT(largest_error(shapes::sphere(1, 4), 0.5), 4e-3);
  EXPECT_LT(largest_error(shapes::rectangle(10, 6, 40, 24), 0.5), 1e-2);
  EXPECT_LT(largest_error(shapes::box(Vec3::Zero(), Vec3(10, 6, 0.01)), 2), 1e-2);
}

TEST(WindingNumber, AgreesWithBruteForceOnSoup) {
  const Mesh whole = shapes::sphere(1, 4);
  const Mesh soup = shapes::selected(
      whole, [](std::size_t f) { return f % 3 != 0; }, [](std::size_t f) { return f % 5 == 0; });
  EXPECT_LT(largest_error(soup, 0.5), 1e-2);
}

// The series is of second order: its error falls with the fourth power of distance or faster.
TEST(WindingNumber, FarFieldConvergesFast) {
  Mesh mesh = shapes::rectangle(1, 1, 8, 8);
  for (Vec3& p : mesh.positions) p.z() = 0.3 * std::sin(3 * p.x()) + 0.2 * p.y() * p.y();
  const std::vector<Vec3i> triangles = triangulate(mesh).triangles;
  const WindingNumber winding(mesh.positions, triangles);
  const Vec3 direction = Vec3(0.3, -0.5, 0.8).normalized();
  const auto error = [&](double distance) {
    const Vec3 p = Vec3(0.5, 0.5, 0.1) + distance * direction;
    return std::abs(winding(p) - brute_force(mesh, triangles, p));
  };
  EXPECT_GT(error(4), 0);
  EXPECT_LT(error(8), error(4) / 12);
}

TEST(WindingNumber, SameBitsForAnyThreadCount) {
  const Mesh mesh = shapes::sphere(1, 5);
  const std::vector<Vec3i> triangles = triangulate(mesh).triangles;
  set_thread_count(1);
  const WindingNumber one(mesh.positions, triangles);
  set_thread_count(4);
  const WindingNumber four(mesh.positions, triangles);
  set_thread_count(0);
  for (const Vec3& p : shapes::points_around(mesh.bounds(), 200, 0.5)) EXPECT_EQ(one(p), four(p));
}

TEST(WindingNumber, OfNothingIsZero) { EXPECT_EQ(WindingNumber({}, {})(Vec3::Zero()), 0); }

TEST(WindingNumber, StaysFiniteOnTheSurface) {
  const Mesh mesh = shapes::box(Vec3::Zero(), Vec3::Ones());
  const WindingNumber winding(mesh.positions, triangulate(mesh).triangles);
  for (const Vec3& p : mesh.positions) EXPECT_TRUE(std::isfinite(winding(p)));
  EXPECT_TRUE(std::isfinite(winding(Vec3(0.5, 0.5, 0))));
  EXPECT_TRUE(std::isfinite(winding(Vec3(0.25, 0.5, 1))));
}

}  // namespace
}  // namespace muslin
