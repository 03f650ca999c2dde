#include "muslin/field/signed_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/thicken.hpp"

namespace muslin {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const auto none = [](std::size_t) { return false; };

double box_distance(const Box& box, const Vec3& p) {
  const Vec3 outside = (box.min() - p).cwiseMax(p - box.max());
  return outside.cwiseMax(0).norm() + std::min(0.0, outside.maxCoeff());
}

// Returns true if a ray from the point crosses the mesh an odd number of times, in a direction that hits no
// edge.
bool odd_crossings(const Mesh& mesh, const std::vector<Vec3i>& triangles, const Vec3& p) {
  const Vec3 direction = Vec3(0.5377, 0.8339, -0.1241).normalized();
  int crossings = 0;
  for (const Vec3i& t : triangles) {
    const Vec3& a = mesh.positions[static_cast<std::size_t>(t.x())];
    const Vec3 ab = mesh.positions[static_cast<std::size_t>(t.y())] - a;
    const Vec3 ac = mesh.positions[static_cast<std::size_t>(t.z())] - a;
    const Vec3 across = direction.cross(ac);
    const double determinant = ab.dot(across);
    const double v = (p - a).dot(across) / determinant;
    const Vec3 other = (p - a).cross(ab);
    const double w = direction.dot(other) / determinant;
    if (v >= 0 && w >= 0 && v + w <= 1 && ac.dot(other) / determinant > 0) ++crossings;
  }
  return crossings % 2 == 1;
}

// A closed mesh with hollows and thin arms: a sphere pushed in and out.
Mesh bumpy(int levels) {
  Mesh mesh = shapes::sphere(1, levels);
  for (Vec3& p : mesh.positions)
    p *= 1 + 0.6 * std::sin(5 * p.x() + 1) * std::cos(4 * p.y()) * std::sin(3 * p.z() + 2);
  return mesh;
}

Grid grid_around(const Box& box, double width, int rings = 2) {
  const Vec3 low = (box.min() / width).array().floor() - rings;
  const Vec3 high = (box.max() / width).array().ceil() + rings;
  return {width * low, width, (high - low).cast<int>() + Vec3i::Ones()};
}

TEST(SignedDistance, OfABoxIsExact) {
  const Box bounds(Vec3(-0.1, -0.1, -0.1), Vec3(10.1, 6.1, 0.1));
  const SignedDistance distance(shapes::box(bounds.min(), bounds.max()));
  EXPECT_TRUE(distance.watertight());
  for (const Vec3& p : shapes::points_around(bounds, 5000, 0.5)) {
    const double exact = box_distance(bounds, p);
    ASSERT_NEAR(distance(p), exact, 1e-12 * std::abs(exact)) << p.transpose();
  }
}

TEST(SignedDistance, IsZeroOnTheSurface) {
  const SignedDistance distance(shapes::box(Vec3::Zero(), Vec3(1, 2, 3)));
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(0.5, 2, 3), Vec3(0.25, 0.5, 0)})
    EXPECT_NEAR(distance(p), 0, 5e-16);
}

TEST(SignedDistance, SignIsRayParityOnClosedMeshes) {
  const Mesh mesh = bumpy(4);
  const std::vector<Vec3i> triangles = triangulate(mesh).triangles;
  const SignedDistance distance(mesh);
  int inside = 0;
  for (const Vec3& p : shapes::points_around(mesh.bounds(), 3000, 0.1)) {
    ASSERT_EQ(distance(p) < 0, odd_crossings(mesh, triangles, p)) << p.transpose();
    inside += distance(p) < 0;
  }
  EXPECT_GT(inside, 300);
}

TEST(SignedDistance, MeshWithAHoleHasAnInside) {
  const Mesh whole = shapes::sphere(1, 4);
  const Mesh holed = shapes::selected(whole, [](std::size_t f) { return f % 97 >= 3; }, none);
  const SignedDistance distance(holed);
  EXPECT_FALSE(distance.watertight());
  for (const Vec3& p : shapes::points_around(whole.bounds(), 1000, 0.2))
    if (std::abs(p.norm() - 1) > 0.1) {
      ASSERT_EQ(distance.inside(p), p.norm() < 1) << p.transpose();
    }
}

TEST(SignedDistance, IsExactFarFromTheOrigin) {
  const Vec3 far(1e6, 2e6, -1e6);
  const Box bounds(far, far + Vec3(1, 0.5, 0.25));
  const SignedDistance distance(shapes::box(bounds.min(), bounds.max()));
  for (const Vec3& p : shapes::points_around(bounds, 1000, 0.5)) {
    const double exact = box_distance(bounds, p);
    ASSERT_NEAR(distance(p), exact, 1e-14 * std::abs(exact) + 1e-16) << p.transpose();
  }
}

TEST(SignedDistance, NeedsFaces) { EXPECT_THROW(SignedDistance{Mesh{}}, Error); }

void expect_samples_equal_the_distance(const Mesh& mesh, const Grid& grid, double band) {
  const SignedDistance distance(mesh);
  const DistanceField field = sample_field(distance, grid, band);
  ASSERT_EQ(field.values.size(), grid.size());
  for (int k = 0; k < grid.samples.z(); ++k)
    for (int j = 0; j < grid.samples.y(); ++j)
      for (int i = 0; i < grid.samples.x(); ++i) {
        const double exact = distance(grid.position(i, j, k));
        const double expected = std::clamp(exact, -band, band);
        ASSERT_EQ(field.values[grid.index(i, j, k)], static_cast<float>(expected))
            << i << " " << j << " " << k << " " << exact;
      }
}

TEST(SampleField, FullFieldHoldsTheDistanceEverywhere) {
  const Mesh mesh = bumpy(3);
  expect_samples_equal_the_distance(mesh, grid_around(mesh.bounds(), 0.11), infinity);
}

TEST(SampleField, NarrowBandIsClampedWithTheRightSign) {
  const Mesh mesh = bumpy(3);
  for (const double band : {0.0, 0.05, 0.3})
    expect_samples_equal_the_distance(mesh, grid_around(mesh.bounds(), 0.09), band);
}

// Two parallel plates closer than a voxel, a plate thinner than one, and a spike between samples.
TEST(SampleField, FeaturesThinnerThanAVoxelHaveTheRightSign) {
  Mesh mesh = shapes::joined(shapes::box(Vec3(0, 0, -0.01), Vec3(3, 3, 0.01)),
                             shapes::box(Vec3(0, 0, 0.03), Vec3(3, 3, 0.04)));
  mesh = shapes::joined(mesh, shapes::box(Vec3(1.49, 1.49, -4), Vec3(1.51, 1.51, 4)));
  for (const double width : {0.5, 0.25, 0.13})
    for (const double band : {infinity, 0.1})
      expect_samples_equal_the_distance(mesh, grid_around(mesh.bounds(), width), band);
}

TEST(SampleField, OpenMeshesChangeSignWhereTheirHolesAre) {
  // A box without its top: the sign changes in the opening, far from any face.
  const Mesh open =
      shapes::selected(shapes::box(Vec3::Zero(), Vec3(4, 4, 4)), [](std::size_t f) { return f != 1; }, none);
  for (const double band : {infinity, 0.3})
    expect_samples_equal_the_distance(open, grid_around(open.bounds(), 0.4), band);
}

TEST(SampleField, AThickenedSheetHasAnInside) {
  const Mesh solid = thicken(shapes::rectangle(10, 6, 10, 6), 0.3);
  const Box bounds = solid.bounds();
  const Grid grid{Vec3(-1, -1, -1), 0.5, Vec3i(25, 17, 5)};
  const DistanceField field = sample_field(SignedDistance(solid), grid, infinity);
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 17; ++j)
      for (int i = 0; i < 25; ++i)
        ASSERT_FLOAT_EQ(field.values[grid.index(i, j, k)],
                        static_cast<float>(box_distance(bounds, grid.position(i, j, k))));
}

TEST(SampleField, SameBitsForAnyThreadCount) {
  const Mesh mesh = bumpy(4);
  const Grid grid = grid_around(mesh.bounds(), 0.07);
  set_thread_count(1);
  const DistanceField one = sample_field(SignedDistance(mesh), grid, infinity);
  set_thread_count(4);
  const DistanceField four = sample_field(SignedDistance(mesh), grid, infinity);
  set_thread_count(0);
  EXPECT_EQ(one.values, four.values);
}

TEST(SampleField, ReportsProgressAndStopsWhenAsked) {
  const Mesh mesh = shapes::sphere(1, 2);
  const SignedDistance distance(mesh);
  const Grid grid = grid_around(mesh.bounds(), 0.03);
  std::vector<double> fractions;
  Progress progress;
  progress.report = [&](double fraction, std::string_view) { fractions.push_back(fraction); };
  sample_field(distance, grid, 0.1, progress);
  EXPECT_GT(fractions.size(), 2u);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1);
  int polls = 0;
  progress.cancelled = [&] { return ++polls == 2; };
  try {
    sample_field(distance, grid, 0.1, progress);
    FAIL() << "not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
  }
}

TEST(SampleField, RejectsInvalidGrids) {
  const SignedDistance distance(shapes::sphere(1, 1));
  EXPECT_THROW(sample_field(distance, {Vec3::Zero(), 0, Vec3i(2, 2, 2)}, 1), Error);
  EXPECT_THROW(sample_field(distance, {Vec3(NAN, 0, 0), 1, Vec3i(2, 2, 2)}, 1), Error);
  EXPECT_THROW(sample_field(distance, {Vec3::Zero(), 1, Vec3i(-1, 2, 2)}, 1), Error);
  EXPECT_THROW(sample_field(distance, {Vec3::Zero(), 1, Vec3i(2, 2, 2)}, -1), Error);
  EXPECT_TRUE(sample_field(distance, {Vec3::Zero(), 1, Vec3i::Zero()}, 1).values.empty());
}

}  // namespace
}  // namespace muslin
