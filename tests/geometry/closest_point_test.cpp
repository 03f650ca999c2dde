#include "muslin/geometry/closest_point.hpp"

#include <cmath>
#include <limits>

#include "geometry/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Distance by a way of its own: alternate projections in long double on the triangle's parameters.
double reference_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long pl = p.cast<long double>(), al = a.cast<long double>(), bl = b.cast<long double>(),
             cl = c.cast<long double>();
  const auto segment = [&](const Long& s, const Long& e) {
    const Long d = e - s;
    const long double length = d.squaredNorm();
    const long double t = length > 0 ? std::clamp((pl - s).dot(d) / length, 0.0L, 1.0L) : 0.0L;
    return (pl - s - t * d).norm();
  };
  long double best = std::min({segment(al, bl), segment(bl, cl), segment(cl, al)});
  const Long normal = (bl - al).cross(cl - al);
  if (normal.squaredNorm() > 0) {
    const auto side = [&](const Long& s, const Long& e) { return normal.dot((e - s).cross(pl - s)); };
    if (side(al, bl) >= 0 && side(bl, cl) >= 0 && side(cl, al) >= 0)
      best = std::min(best, std::abs(normal.dot(pl - al)) / normal.norm());
  }
  return static_cast<double>(best);
}

double brute_distance(const Mesh& mesh, const std::vector<Vec3i>& triangles, const Vec3& p) {
  const auto at = [&](int v) { return mesh.positions[static_cast<std::size_t>(v)]; };
  double best = infinity;
  for (const Vec3i& t : triangles)
    best = std::min(best, reference_distance(p, at(t.x()), at(t.y()), at(t.z())));
  return best;
}

void expect_matches_brute_force(const Mesh& mesh, int count, double tolerance) {
  const std::vector<Vec3i> triangles = triangulate(mesh).triangles;
  const ClosestPointQuery query(mesh.positions, triangles);
  for (const Vec3& p : shapes::points_around(mesh.bounds(), count, 0.5)) {
    const ClosestPoint found = query(p);
    const double expected = brute_distance(mesh, triangles, p);
    const double size = (mesh.bounds().max() - mesh.bounds().min()).norm();
    ASSERT_NEAR(found.distance, expected, tolerance * expected + 2e-16 * size) << p.transpose();
    ASSERT_GE(found.triangle, 0);
    const Vec3i& t = triangles[static_cast<std::size_t>(found.triangle)];
    Vec3 from_weights = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(found.barycentric[k], 0);
      from_weights += found.barycentric[k] * mesh.positions[static_cast<std::size_t>(t[k])];
    }
    EXPECT_NEAR(found.barycentric.sum(), 1, 1e-14);
    const double largest = mesh.bounds().max().cwiseAbs().maxCoeff() + size + expected;
    EXPECT_NEAR((from_weights - found.point).norm(), 0, 1e-14 * largest);
    EXPECT_NEAR((p - found.point).norm(), expected, 1e-14 * largest);
  }
}

TEST(ClosestPoint, EqualsBruteForceOnABox) {
  expect_matches_brute_force(shapes::box(Vec3(-0.1, -0.1, -0.1), Vec3(10.1, 6.1, 0.1)), 2000, 4e-15);
}

TEST(ClosestPoint, EqualsBruteForceOnASphere) {
  expect_matches_brute_force(shapes::sphere(1, 3), 500, 4e-15);
}

TEST(ClosestPoint, EqualsBruteForceFarFromTheOrigin) {
  Mesh mesh = shapes::sphere(0.5, 3, Vec3(1e6, -3e6, 2e5));
  expect_matches_brute_force(mesh, 300, 1e-14);
}

TEST(ClosestPoint, EqualsBruteForceOnTinyAndHugeMeshes) {
  expect_matches_brute_force(shapes::sphere(1e-9, 2), 200, 1e-14);
  expect_matches_brute_force(shapes::sphere(1e9, 2), 200, 1e-14);
}

// A soup of needles, doubled corners and points among proper triangles.
TEST(ClosestPoint, HandlesDegenerateTrianglesAsSegmentsAndPoints) {
  Mesh mesh;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto point = [&] {
    const double x = unit(random), y = unit(random), z = unit(random);
    return Vec3(x, y, z);
  };
  std::vector<Vec3i> triangles;
  for (int n = 0; n < 200; ++n) {
    const Vec3 a = point(), b = point();
    const double thin = std::pow(10.0, -4 * (n % 5));
    const Vec3 c = n % 4 == 0   ? a
                   : n % 4 == 1 ? Vec3(a + 0.25 * (b - a))
                   : n % 4 == 2 ? Vec3(a + 0.3 * (b - a) + thin * 0.1 * point())
                                : Vec3(a + 0.1 * point());
    const int v = static_cast<int>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, n % 8 == 0 ? a : b, c});
    triangles.emplace_back(v, v + 1, v + 2);
  }
  const ClosestPointQuery query(mesh.positions, triangles);
  for (const Vec3& p : shapes::points_around(mesh.bounds(), 1000, 0.3)) {
    const double expected = brute_distance(mesh, triangles, p);
    ASSERT_NEAR(query(p).distance, expected, 1e-9 * expected + 1e-12);
  }
}

TEST(ClosestPoint, IsExactAtCornersOfABox) {
  const Mesh mesh = shapes::box(Vec3(0, 0, -0.25), Vec3(10, 6, 0.25));
  const ClosestPointQuery query(mesh.positions, triangulate(mesh).triangles);
  EXPECT_DOUBLE_EQ(query(Vec3(-3, -4, 0)).distance, 5);
  EXPECT_DOUBLE_EQ(query(Vec3(5, 3, 0)).distance, 0.25);
  EXPECT_EQ(query(Vec3(5, 3, 0.25)).distance, 0);
  EXPECT_EQ(query(Vec3(10, 6, 0.25)).distance, 0);
}

TEST(ClosestPoint, TiesGoToTheSmallestIndexWhateverTheHint) {
  const Mesh mesh = shapes::joined(shapes::sphere(1, 2), shapes::sphere(1, 2));  // every triangle twice
  const std::vector<Vec3i> triangles = triangulate(mesh).triangles;
  const ClosestPointQuery query(mesh.positions, triangles);
  const int half = static_cast<int>(triangles.size() / 2);
  for (const Vec3& p : shapes::points_around(mesh.bounds(), 200, 0.5)) {
    const ClosestPoint found = query(p);
    EXPECT_LT(found.triangle, half);
    for (const int hint : {0, half, found.triangle + half}) {
      const ClosestPoint hinted = query(p, infinity, hint);
      EXPECT_EQ(hinted.triangle, found.triangle);
      EXPECT_EQ(hinted.distance, found.distance);
    }
  }
}

TEST(ClosestPoint, RespectsTheSearchDistance) {
  const Mesh mesh = shapes::box(Vec3::Zero(), Vec3::Ones());
  const ClosestPointQuery query(mesh.positions, triangulate(mesh).triangles);
  EXPECT_EQ(query(Vec3(3, 0.5, 0.5), 1.5).triangle, -1);
  EXPECT_EQ(query(Vec3(3, 0.5, 0.5), 1.5).distance, infinity);
  EXPECT_EQ(query(Vec3(3, 0.5, 0.5), 2).distance, 2);
  EXPECT_EQ(query(Vec3(3, 0.5, 0.5), 1.5, 0).triangle, -1);
}

TEST(ClosestPoint, IsExactFromVeryFarAway) {
  const Mesh mesh = shapes::box(Vec3::Zero(), Vec3::Ones());
  const ClosestPointQuery query(mesh.positions, triangulate(mesh).triangles);
  EXPECT_DOUBLE_EQ(query(Vec3(1e12, 0.5, 0.5)).distance, 1e12 - 1);
  EXPECT_DOUBLE_EQ(query(Vec3(1e30, 0.5, 0.5)).distance, 1e30);
}

TEST(ClosestPoint, RejectsPointsThatAreNotFinite) {
  const Mesh mesh = shapes::box(Vec3::Zero(), Vec3::Ones());
  const ClosestPointQuery query(mesh.positions, triangulate(mesh).triangles);
  EXPECT_THROW(query(Vec3(NAN, 0, 0)), Error);
  EXPECT_THROW(query(Vec3(0, infinity, 0)), Error);
}

}  // namespace
}  // namespace muslin
