// A point over a plane that turns: derivatives by finite differences, and steps that never bring it nearer
// than asked, nor stop it for nothing.
#include "muslin/contact/turning_plane.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace muslin {
namespace {

using Four = std::array<Vec3, 4>;

Four moved(const Four& x, const Four& u, double s) {
  Four at;
  for (std::size_t i = 0; i < 4; ++i) at[i] = x[i] + s * u[i];
  return at;
}

/// A point some way over a turned plane.
Four random_four(std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  const Mat3 turn =
      Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized().toRotationMatrix();
  const Vec3 a = vector();
  return {a + turn * Vec3(2 * any(random), 2 * any(random), 0.05 + std::abs(any(random))), a,
          a + turn * Vec3(1, 0, 0), a + turn * Vec3(0, 1, 0)};
}

TEST(TurningPlane, HasConsistentDerivatives) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Four x = random_four(random);
    const OverPlane at = over_plane(x);
    EXPECT_GT(at.distance, 0);
    for (std::size_t i = 0; i < 4; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        Four step{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        step[i][axis] = 1;
        const double h = 1e-6;
        const double slope =
            (over_plane(moved(x, step, h)).distance - over_plane(moved(x, step, -h)).distance) / (2 * h);
        EXPECT_NEAR(slope, at.weights[i] * at.normal[axis], 1e-7);
      }
    }
  }
}

TEST(TurningPlane, NeverAllowsLessThanTheRequiredDistance) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> any(-1, 1);
  int stopped = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Four x = random_four(random);
    Four u;
    for (Vec3& v : u) v = 0.4 * Vec3(any(random), any(random), any(random));
    const double required = 0.9 * over_plane(x).distance * std::abs(any(random));
    const double safe = safe_fraction_over_plane(x, u, required);
    EXPECT_GT(safe, 0);
    EXPECT_LE(safe, 1);
    stopped += safe < 1 ? 1 : 0;
    for (int k = 0; k <= 64; ++k)
      EXPECT_GE(over_plane(moved(x, u, safe * k / 64)).distance, required - 1e-12) << trial;
  }
  EXPECT_GT(stopped, 400);
  EXPECT_LT(stopped, 1600);
}

TEST(TurningPlane, StopsAtTheEndOfTheSafeMotion) {
  const Four x = {Vec3(0.3, 1, 0), Vec3::Zero(), Vec3(0, 0, 1), Vec3(1, 0, 0)};
  ASSERT_NEAR(over_plane(x).distance, 1, 1e-15);
  const Four falls = {Vec3(5, -2, 0), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  EXPECT_NEAR(safe_fraction_over_plane(x, falls, 0.1), 0.45, 1e-9);
  // Sliding and separating motions are not limited.
  const Four slides = {Vec3(5, 0, 0), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  EXPECT_EQ(safe_fraction_over_plane(x, slides, 1 - 1e-6), 1);
  // Turned about z by 0.1 the plane comes up by 0.1 x.
  const Four turns = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3(0, 0.1, 0)};
  EXPECT_EQ(safe_fraction_over_plane(x, turns, 0.96), 1);
  // Bounds of a cubic: some of the way is left.
  EXPECT_LE(safe_fraction_over_plane(x, turns, 0.98), 2.0 / 3);
  EXPECT_GT(safe_fraction_over_plane(x, turns, 0.98), 0.55);
}

}  // namespace
}  // namespace muslin
