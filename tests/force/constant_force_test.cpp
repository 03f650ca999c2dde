// Gravity and point forces: what they pull, when, and the battery.
#include <limits>

#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/force/gravity.hpp"
#include "muslin/force/point_force.hpp"

namespace muslin {
namespace {

StepContext step(double begin, double end) {
  StepContext context;
  context.time_begin = begin;
  context.time_end = end;
  context.dt = end - begin;
  return context;
}

const Window always{0, std::numeric_limits<double>::infinity()};
const Keyed down{{{0, Vec3(0, -9.8, 0)}}};

TEST(Gravity, ActsOnEveryMassAndStoresHeight) {
  const Gravity gravity({1, 2, 0}, down, always);
  const auto potential = gravity.potential(step(0, 0.1));
  const std::vector<Vec3> x = {Vec3(5, 1, 0), Vec3(0, 3, 7), Vec3(0, 9, 0)};
  EXPECT_NEAR(potential->value(x), 9.8 * (1 + 6), 1e-12);
  const std::vector<Vec3> g = test::gradient(*potential, x);
  EXPECT_EQ(g[0], Vec3(0, 9.8, 0));
  EXPECT_EQ(g[1], Vec3(0, 19.6, 0));
  EXPECT_EQ(g[2], Vec3::Zero());
}

TEST(Gravity, PassesTheBattery) {
  const std::vector<Vec3> x = test::random_vectors(20000, 3, 1);
  const Gravity gravity(std::vector<double>(20000, 0.3), down, always);
  test::expect_potential_is_sound(*gravity.potential(step(0, 0.1)), x);
}

TEST(Gravity, FollowsItsKeysAndItsWindow) {
  const Gravity gravity({1}, Keyed{{{0, Vec3::Zero()}, {1, Vec3(0, -8, 0)}}}, {0.25, 2});
  const auto pull = [&](double begin, double end) {
    const auto potential = gravity.potential(step(begin, end));
    return potential ? test::gradient(*potential, std::vector<Vec3>{Vec3::Zero()})[0].y() : 0.0;
  };
  EXPECT_EQ(gravity.potential(step(0, 0.25)), nullptr);
  EXPECT_EQ(pull(0.25, 0.5), 4);
  EXPECT_EQ(pull(0, 0.5), 2);  // acts during half the step
  EXPECT_EQ(pull(1, 1.5), 8);
  EXPECT_EQ(gravity.potential(step(2, 2.5)), nullptr);
}

TEST(PointForce, ActsOnEachListedVertexWithTheFullForce) {
  const PointForce force({0, 2}, Keyed{{{0, Vec3(1, -2, 3)}}}, always);
  const std::vector<Vec3> x = test::random_vectors(4, 1, 2);
  const auto potential = force.potential(step(0, 0.1));
  const std::vector<Vec3> g = test::gradient(*potential, x);
  for (const std::size_t v : {0, 2}) EXPECT_EQ(g[v], Vec3(-1, 2, -3));
  for (const std::size_t v : {1, 3}) EXPECT_EQ(g[v], Vec3::Zero());
  test::expect_potential_is_sound(*potential, x);
  EXPECT_EQ(PointForce({0}, down, {1, 2}).potential(step(0, 1)), nullptr);
}

}  // namespace
}  // namespace muslin
