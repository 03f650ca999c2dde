// Rigid bodies that nothing pushes: their shape, momentum and spin stay, at small and at large turns a step.
#include "muslin/solver/rigid_prediction.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "muslin/geometry/affine_frame.hpp"

namespace muslin {
namespace {

State spinning(const Vec3& radii, const Vec3& spin, const Vec3& velocity) {
  const AffineFrame frame{Vec3(1, 2, 3), Mat3::Identity(), radii};
  State state;
  for (const Vec3& q : frame.corners()) {
    state.positions.push_back(q);
    state.velocities.push_back(velocity + spin.cross(q - frame.centre));
  }
  return state;
}

Vec3 centre(ConstVectors x) { return (x[0] + x[1] + x[2] + x[3]) / 4; }

Vec3 angular_momentum(const State& state) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    sum += (state.positions[i] - centre(state.positions)).cross(state.velocities[i]);
  return sum;
}

double energy(const State& state) {
  double sum = 0;
  for (const Vec3& v : state.velocities) sum += v.squaredNorm() / 2;
  return sum;
}

/// Makes a step without forces, as a solver does.
void drift(Integrator integrator, double dt, State& state) {
  StepContext context = step_context(integrator, state, dt);
  predict_rigid(integrator, state, 0, context);
  state.previous_positions = state.positions;
  state.previous_velocities = state.velocities;
  state.previous_dt = dt;
  for (std::size_t v = 0; v < 4; ++v) {
    state.positions[v] = context.inertial_prediction[v];
    state.velocities[v] = (state.positions[v] - context.anchor[v]) / context.dt;
  }
  state.time += dt;
}

double worst_length_change(const State& state, const State& start) {
  double worst = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double rest = (start.positions[i] - start.positions[j]).norm();
      worst = std::max(worst, std::abs((state.positions[i] - state.positions[j]).norm() / rest - 1));
    }
  }
  return worst;
}

TEST(RigidPrediction, ABallKeepsItsSpin) {
  for (const double turn : {0.01, 0.5, 2.0}) {  // a step [rad]
    const double dt = 0.01;
    const State start = spinning(Vec3(0.2, 0.2, 0.2), turn / dt * Vec3(0, 0.6, 0.8), Vec3(1, 0, 0));
    State state = start;
    for (int i = 0; i < 100; ++i) drift(Integrator::implicit_euler, dt, state);
    EXPECT_LT((centre(state.positions) - Vec3(2, 2, 3)).norm(), 1e-12);
    EXPECT_LT((angular_momentum(state) - angular_momentum(start)).norm(),
              1e-11 * angular_momentum(start).norm());
    EXPECT_NEAR(energy(state), energy(start), 1e-11 * energy(start));
    EXPECT_LT(worst_length_change(state, start), 1e-11);
    // And it has turned as far as it should.
    const Mat3 turned = Eigen::AngleAxisd(100 * turn, Vec3(0, 0.6, 0.8)).toRotationMatrix();
    EXPECT_LT(
        (state.positions[0] - centre(state.positions) - turned * (start.positions[0] - Vec3(1, 2, 3))).norm(),
        1e-10);
  }
}

TEST(RigidPrediction, ATopWobblesAtItsRate) {
  // Torque-free symmetric top: in space, the axis goes around L at |L|/I₁ (Goldstein, Classical Mechanics,
  // §5.6).
  const Vec3 radii(0.1, 0.1, 0.3), spin(2, 0, 10);
  const State start = spinning(radii, spin, Vec3::Zero());
  const double across = 4 * (0.1 * 0.1 + 0.3 * 0.3);  // I₁ of four masses of 1
  const Vec3 momentum = angular_momentum(start);
  const double period = 2 * std::numbers::pi * across / momentum.norm();
  State state = start;
  const int steps = 1000;
  for (int i = 0; i < steps; ++i) drift(Integrator::implicit_euler, period / steps, state);
  const auto half_axis = [](const State& s, std::size_t row) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < 4; ++c) sum += corner_signs[c][row] * s.positions[c] / 4;
    return sum;
  };
  EXPECT_LT((half_axis(state, 2) - half_axis(start, 2)).norm(), 1e-3 * 0.3);
  EXPECT_NEAR(half_axis(state, 2).norm(), 0.3, 1e-9);
  EXPECT_LT((angular_momentum(state) - momentum).norm(), 1e-9 * momentum.norm());
  EXPECT_NEAR(energy(state), energy(start), 1e-3 * energy(start));
}

TEST(RigidPrediction, Bdf2StaysRigidAndKeepsNearlyAllSpin) {
  const double dt = 0.01, turn = 0.05;
  const State start = spinning(Vec3(0.2, 0.2, 0.2), turn / dt * Vec3(0, 0, 1), Vec3(0, 1, 0));
  State state = start;
  const double first = angular_momentum(start).norm();
  for (int i = 0; i < 100; ++i) drift(Integrator::bdf2, dt, state);
  EXPECT_LT(worst_length_change(state, start), 1e-11);
  EXPECT_NEAR(angular_momentum(state).norm(), first, 3e-3 * first);
}

TEST(RigidPrediction, DoesNotChangeOthersAndExplicitSteps) {
  State state = spinning(Vec3(0.2, 0.2, 0.2), Vec3(0, 0, 50), Vec3::Zero());
  state.positions.insert(state.positions.begin(), Vec3(7, 7, 7));
  state.velocities.insert(state.velocities.begin(), Vec3(1, 0, 0));
  StepContext context = step_context(Integrator::implicit_euler, state, 0.01);
  const StepContext plain = context;
  predict_rigid(Integrator::implicit_euler, state, 1, context);
  EXPECT_EQ(context.inertial_prediction[0], plain.inertial_prediction[0]);
  EXPECT_EQ(context.anchor[0], plain.anchor[0]);
  EXPECT_EQ(context.rigidly_rotated, (std::vector<std::uint8_t>{0, 1, 1, 1, 1}));
  EXPECT_NE(context.inertial_prediction[1], plain.inertial_prediction[1]);
  StepContext explicit_step = step_context(Integrator::symplectic_euler, state, 0.01);
  const StepContext before = explicit_step;
  predict_rigid(Integrator::symplectic_euler, state, 1, explicit_step);
  EXPECT_EQ(explicit_step.inertial_prediction, before.inertial_prediction);
  EXPECT_TRUE(explicit_step.rigidly_rotated.empty());
}

}  // namespace
}  // namespace muslin
