#include "muslin/post/smoothing.hpp"

#include <cmath>
#include <numbers>

#include "geometry/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

/// Waves of amplitude a and wavelength l along x.
Mesh wavy(double amplitude, double wavelength, int cells) {
  Mesh mesh = shapes::rectangle(1, 1, cells, cells);
  for (Vec3& x : mesh.positions) x.z() = amplitude * std::sin(2 * std::numbers::pi * x.x() / wavelength);
  return mesh;
}

double greatest_height(ConstVectors points) {
  double height = 0;
  for (const Vec3& x : points)
    if (std::abs(x.x() - 0.5) < 0.3 && std::abs(x.y() - 0.5) < 0.3)
      height = std::max(height, std::abs(x.z()));
  return height;
}

TEST(Smoothing, RemovesShortWavesAndKeepsLongOnes) {
  const Mesh fine = wavy(0.01, 2.0 / 32, 32), coarse = wavy(0.01, 0.5, 32);
  const Smoothing smoothing(fine, 10);
  // Zigzags of two edges sampled away from their zeros.
  Mesh zigzag = fine;
  for (std::size_t v = 0; v < zigzag.positions.size(); ++v) {
    Vec3& x = zigzag.positions[v];
    x.z() = std::lround(x.x() * 32) % 2 == 0 ? 0.01 : -0.01;
  }
  EXPECT_LT(greatest_height(smoothing.points(zigzag.positions)), 1e-3);
  EXPECT_NEAR(greatest_height(smoothing.points(coarse.positions)), 0.01, 5e-4);
}

TEST(Smoothing, KeepsTheVolumeOfASphere) {
  const Mesh sphere = shapes::sphere(1, 3);
  Mesh smooth = sphere;
  smooth.positions = Smoothing(sphere, 20).points(sphere.positions);
  EXPECT_NEAR(shapes::volume(smooth) / shapes::volume(sphere), 1, 0.012);  // 22 edges around
}

TEST(Smoothing, KeepsAFlatSquareInItsOutlineWithItsCorners) {
  const Mesh square = shapes::rectangle(1, 1, 8, 8);
  const std::vector<Vec3> smooth = Smoothing(square, 100).points(square.positions);
  for (std::size_t v = 0; v < smooth.size(); ++v) {
    const Vec3& x = square.positions[v];
    EXPECT_NEAR(smooth[v].z(), 0, 1e-15);
    for (int axis = 0; axis < 2; ++axis) {
      if (x[axis] == 0 || x[axis] == 1) {
        EXPECT_NEAR(smooth[v][axis], x[axis], 1e-12) << v;
      }
    }
  }
}

TEST(Smoothing, WithoutRoundsChangesNothingAndThreadsDoNotMatter) {
  const Mesh mesh = wavy(0.1, 0.3, 80);
  EXPECT_EQ(Smoothing(mesh, 0).points(mesh.positions), mesh.positions);
  const Smoothing smoothing(mesh, 3);
  const std::vector<Vec3> points = smoothing.points(mesh.positions);
  set_thread_count(1);
  EXPECT_EQ(smoothing.points(mesh.positions), points);
  set_thread_count(0);
}

}  // namespace
}  // namespace muslin
