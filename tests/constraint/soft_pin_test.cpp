// Soft pins: forces and derivatives of their springs, targets that move and scale, anchors in the history.
#include "muslin/constraint/soft_pin.hpp"

#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/constraint/pin_targets.hpp"
#include "muslin/core/error.hpp"

namespace muslin {
namespace {

Pin soft(std::vector<int> vertices) {
  Pin pin;
  pin.name = "hand";
  pin.vertices = std::move(vertices);
  pin.stiffness = {300, 20};
  pin.damping = {4, 0};
  pin.motion.keys = {{0, Vec3::Zero()}, {1, Vec3(2, 0, 0)}};
  return pin;
}

/// A step of implicit Euler from the positions.
StepContext step_from(const std::vector<Vec3>& positions, double begin, double end) {
  StepContext step;
  step.time_begin = begin;
  step.time_end = end;
  step.dt = step.length = end - begin;
  step.anchor = positions;
  step.positions = positions;
  return step;
}

TEST(SoftPin, PassesTheBattery) {
  const std::vector<Vec3> x = test::random_vectors(4, 1, 3);
  const auto springs = SoftPin(soft({1, 3})).potential(step_from(x, 0.25, 0.5));
  test::expect_gradient_matches_value(*springs, x);
  test::expect_hessian_matches_gradient(*springs, x);
}

TEST(SoftPin, PullsByItsSpringsAndItsDashpotsTowardsMovingTargets) {
  const std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  SoftPin pin(soft({1, 3}));
  const auto springs = pin.potential(step_from(x, 0, 0.5));
  // The targets move by 1 m in the step, at 2 m/s.
  std::vector<Vec3> g(4, Vec3::Zero());
  springs->add_gradient(x, g);
  EXPECT_LT((-g[1] - Vec3(300 * 1.0 + 4 * 2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((-g[3] - Vec3(20 * 1.0, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(g[0], Vec3(Vec3::Zero()));

  History history;
  pin.end_step(*springs, x, history);
  const std::vector<Vec3> forces = SoftPin::forces(soft({1, 3}), history);
  ASSERT_EQ(forces.size(), 2U);
  EXPECT_EQ(forces[0], Vec3(-g[1]));
  EXPECT_TRUE(SoftPin::forces(soft({0, 3}), history).empty());  // other vertices: another pin

  // The anchors stay those of the beginning.
  std::vector<Vec3> moved = x;
  for (Vec3& p : moved) p.x() += 1;
  StepContext next = step_from(moved, 0.5, 0.75);
  next.history = &history;
  std::vector<Vec3> later(4, Vec3::Zero());
  pin.potential(next)->add_gradient(moved, later);
  EXPECT_LT((-later[3] - Vec3(20 * 0.5, 0, 0)).norm(), 1e-12);
}

TEST(SoftPin, GoesOnFromWhereItsVerticesAreIfItsAnchorsAreLost) {
  const std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Vec3> g(4, Vec3::Zero());
  SoftPin(soft({1, 3})).potential(step_from(x, 0.25, 0.5))->add_gradient(x, g);
  EXPECT_LT((-g[1] - Vec3(300 * 0.5 + 4 * 2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((-g[3] - Vec3(20 * 0.5, 0, 0)).norm(), 1e-12);
}

TEST(SoftPin, ActsInItsWindowOnly) {
  Pin pin = soft({1, 3});
  pin.from = 0.5;
  pin.until = 1;
  const std::vector<Vec3> x(4, Vec3::Zero());
  EXPECT_EQ(SoftPin(pin).potential(step_from(x, 0.2, 0.4)), nullptr);
  EXPECT_NE(SoftPin(pin).potential(step_from(x, 0.4, 0.6)), nullptr);
  EXPECT_EQ(SoftPin(pin).potential(step_from(x, 0.8, 1.0)), nullptr);
}

TEST(SoftPin, RefusesConstantsThatDoNotFit) {
  Pin few = soft({1, 3}), negative = soft({1, 3});
  few.stiffness.pop_back();
  negative.damping[0] = -1;
  EXPECT_THROW(SoftPin{few}, Error);
  EXPECT_THROW(SoftPin{negative}, Error);
}

TEST(PinTargets, ScaleAboutThePivotBeforeTheyTurnAndMove) {
  Pin pin;
  pin.vertices = {0};
  pin.motion.pivot = Vec3(1, 0, 0);
  pin.motion.keys = {
      {0, Vec3::Zero()},
      {2, Vec3(0, 0, 1), Eigen::Quaterniond(Eigen::AngleAxisd(EIGEN_PI / 2, Vec3::UnitZ())), Vec3(3, 1, 1)}};
  const Vec3 anchor(2, 1, 0);
  EXPECT_LT((PinTargets(pin, 2).at(0, anchor) - Vec3(1 - 1, 3, 1)).norm(), 1e-14);
  EXPECT_LT((pin.motion.scale_at(1) - Vec3(2, 1, 1)).norm(), 1e-14);
  // A pin that begins later starts where its vertices are, whatever the scale is then.
  pin.from = 1;
  EXPECT_LT((PinTargets(pin, 1).at(0, anchor) - anchor).norm(), 1e-14);
  EXPECT_LT((PinTargets(pin, 1.7).anchor(0, PinTargets(pin, 1.7).at(0, anchor)) - anchor).norm(), 1e-14);
}

}  // namespace
}  // namespace muslin
