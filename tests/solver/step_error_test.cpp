// The estimate of a step's error against errors that are known: of masses that are pulled back to where they
// would drift, g = m (x − x̃) and H = M.
#include "muslin/solver/step_error.hpp"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace muslin {
namespace {

class OfMasses : public testing::Test {
 protected:
  static constexpr double dt = 1.0 / 240, tolerance = 0.1;
  std::vector<double> masses{1, 2, 1000, 2000}, accelerations{9.81, 9.81}, edges{0.02, 0.02};
  std::vector<int> parts{0, 0, 1, 1};
  std::vector<std::uint8_t> fixed{0, 0, 0, 0};
  std::vector<Vec3> goal, from;
  StepProblem problem;

  void SetUp() override {
    goal.assign(4, Vec3::Zero());
    from.assign(4, Vec3(1, 0, 0));
    problem.masses = masses;
    problem.fixed = fixed;
    problem.targets = goal;
    problem.parts = parts;
    problem.accelerations = accelerations;
    problem.edges = edges;
  }
  std::vector<Vec3> gradient(const std::vector<Vec3>& x) const {
    std::vector<Vec3> g(x);
    for (std::size_t v = 0; v < g.size(); ++v) g[v] = masses[v] * (x[v] - goal[v]);
    return g;
  }
  /// Goes from x by all but `left` of the way to the goal, by part, judged by `error`; P = M.
  bool step(StepError& error, std::vector<Vec3>& x, std::array<double, 2> left) const {
    const std::vector<Vec3> before = x;
    std::vector<Vec3> s(x);
    for (std::size_t v = 0; v < x.size(); ++v) {
      s[v] = -(1 - left[static_cast<std::size_t>(parts[v])]) * (x[v] - goal[v]);
      x[v] += s[v];
    }
    error.begin(gradient(before), before);
    return error.end(x, from, gradient(x), x, s, s, 1);
  }
  double allowed() const { return tolerance * 9.81 * dt * dt; }
};

TEST_F(OfMasses, IsExactAfterAStepThatLeavesAShare) {
  const IncrementalPotential function(problem, goal, dt);
  for (const double left : {0.5, 0.1, 0.01}) {
    StepError error(problem, function, tolerance);
    std::vector<Vec3> x(4, Vec3(0, 1e-3, 0));
    step(error, x, {left, left});
    EXPECT_NEAR(error.largest() / (left * 1e-3), 1, 1e-9);
  }
}

TEST_F(OfMasses, ComparesTheErrorWithTheAllowedError) {
  const IncrementalPotential function(problem, goal, dt);
  for (const double over : {0.9, 1.1}) {
    StepError error(problem, function, tolerance);
    std::vector<Vec3> x(4, Vec3(0, 10 * over * allowed(), 0));
    EXPECT_EQ(step(error, x, {0.1, 0.1}), over < 1);
  }
}

TEST_F(OfMasses, DoesNotHideALightPartBehindAHeavyOne) {
  const IncrementalPotential function(problem, goal, dt);
  StepError error(problem, function, tolerance);
  std::vector<Vec3> x(4, Vec3(0, 5 * allowed(), 0));
  EXPECT_FALSE(step(error, x, {0.5, 1e-6})) << "the light part is off by 2.5 times what is allowed";
  StepError other(problem, function, tolerance);
  x.assign(4, Vec3(0, 5 * allowed(), 0));
  EXPECT_TRUE(step(other, x, {0.1, 1e-6}));
}

TEST_F(OfMasses, ShrinkingStepsCountAsConvergence) {
  // Stiff contact that comes in raises the residual, though the motion hardly changes any more.
  const IncrementalPotential function(problem, goal, dt);
  StepError error(problem, function, tolerance);
  std::vector<Vec3> x(4, Vec3(0, 1e-3, 0));
  step(error, x, {0.1, 0.1});
  const std::vector<Vec3> s(4, Vec3(0, -0.01 * 0.9e-3, 0)), large(4, Vec3(0, 1, 0));
  error.begin(gradient(s), s);
  error.end(x, from, large, large, s, s, 1);
  EXPECT_NEAR(error.largest() / (0.01 / 0.99 * 0.01 * 0.9e-3), 1, 1e-9);
}

TEST_F(OfMasses, UsesTheResidualIfASystemWasNotSolved) {
  // Conjugate gradients that stop early, or that hardly see a light part: a step of nothing, the error stays.
  const IncrementalPotential function(problem, goal, dt);
  StepError error(problem, function, tolerance);
  std::vector<Vec3> x(4, Vec3(0, 1e-2, 0));
  step(error, x, {0.3, 0.3});
  EXPECT_FALSE(step(error, x, {0.99, 0.01}));
}

TEST_F(OfMasses, UsesTheLengthOfALimitedMotion) {
  // The guard left a hundredth of the first step. A second one of a tenth of its length shows no convergence.
  const IncrementalPotential function(problem, goal, dt);
  StepError error(problem, function, tolerance);
  const std::vector<Vec3> x(4, Vec3(0, 1e-3, 0)), s(4, Vec3(0, -1e-3, 0)), d(4, Vec3(0, -1e-5, 0));
  error.begin(gradient(x), x);
  error.end(x, from, gradient(x), x, s, d, 1);
  const std::vector<Vec3> next(4, Vec3(0, -1e-4, 0)), near(4, Vec3(0, 1e-4, 0));
  error.begin(gradient(near), near);
  EXPECT_FALSE(error.end(near, from, gradient(near), near, next, next, 1));
}

TEST_F(OfMasses, UsesTheResidualIfItFallsFaster) {
  const IncrementalPotential function(problem, goal, dt);
  StepError error(problem, function, tolerance);
  std::vector<Vec3> x(4, Vec3(0, 1e-3, 0));
  step(error, x, {0.5, 0.5});
  step(error, x, {0.01, 0.01});
  EXPECT_NEAR(error.largest() / (0.01 * 0.5e-3), 1, 1e-9);
}

TEST_F(OfMasses, CountsThePartOfAStepThatTheGuardRemoved) {
  const IncrementalPotential function(problem, goal, dt);
  StepError error(problem, function, tolerance);
  const std::vector<Vec3> x(4, Vec3(0, 1e-9, 0)), s(4, Vec3(0, -1e-3, 0)), d(4, Vec3(0, -0.4e-3, 0));
  error.begin(gradient(x), x);
  EXPECT_FALSE(error.end(x, from, goal, goal, s, d, 0.5));
  EXPECT_NEAR(error.largest() / 0.8e-3, 1, 1e-9);
}

TEST_F(OfMasses, FollowsGravityHoweverWeak) {
  for (const double gravity : {9.81, 1e-3}) {
    accelerations.assign(2, gravity);
    problem.accelerations = accelerations;
    const IncrementalPotential function(problem, goal, dt);
    StepError error(problem, function, tolerance);
    // At rest, and out of balance by the whole of gravity, or by a two-hundredth.
    std::vector<Vec3> g(4);
    for (std::size_t v = 0; v < 4; ++v) g[v] = Vec3(0, masses[v] * gravity * dt * dt, 0);
    EXPECT_FALSE(error.bound(goal, g));
    for (Vec3& each : g) each *= 0.005;
    EXPECT_TRUE(error.bound(goal, g));
  }
}

}  // namespace
}  // namespace muslin
