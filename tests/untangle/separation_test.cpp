// Separations are one-sided springs between places of surfaces.
#include "muslin/untangle/separation.hpp"

#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

namespace muslin {
namespace {

TEST(Separation, HasTheDerivativesOfItsEnergy) {
  const auto map = std::make_shared<const SurfaceMap>(
      5, std::vector<int>{0, 2, 3, 4, 5},
      std::vector<SurfaceMap::Entry>{{0, 0.4}, {1, 0.6}, {2, 1}, {3, 1}, {4, 1}});
  Separation apart, alone;
  apart.points = {0, 1, 2, 3};
  apart.weights = {1, -0.2, -0.3, -0.5};
  apart.normal = Vec3(1, 2, -2) / 3;
  apart.gap = 10;
  apart.stiffness = 70;
  alone.points[0] = 0;
  alone.weights[0] = 1;
  alone.normal = Vec3(0, 1, 0);
  alone.gap = 3;
  alone.stiffness = 20;
  const SeparationPotential potential(map, {apart, alone});
  const std::vector<Vec3> x = test::random_vectors(5, 1, 3);
  test::expect_gradient_matches_value(potential, x);
  test::expect_hessian_matches_gradient(potential, x);
  // Between surfaces it exerts no force in all, and beyond the gap none.
  std::vector<Vec3> g(5, Vec3::Zero());
  SeparationPotential(map, {apart}).add_gradient(x, g);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& force : g) sum += force;
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_GT(g[0].norm(), 1);
  apart.gap = -10;
  EXPECT_EQ(SeparationPotential(map, {apart}).value(x), 0);
}

}  // namespace
}  // namespace muslin
