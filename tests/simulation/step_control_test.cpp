// The steps that the program chooses: by motion and size, not by resolution; shorter where steps are hard.
#include "muslin/simulation/step_control.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace muslin {
namespace {

constexpr double frame = 1.0 / 60;

/// Parts of one vertex each, of 1 kg, 1 m across with edges of 2 cm.
struct Moving {
  ModelParts parts;
  std::vector<double> loads, masses;
  State state;

  void add(const Vec3& velocity, const Vec3& acceleration) {
    parts.of_vertex.push_back(static_cast<int>(parts.edges.size()));
    parts.edges.push_back(0.02);
    parts.sizes.push_back(1);
    parts.longest_steps.push_back(1);
    loads.push_back(0);
    masses.push_back(1);
    state.previous_dt = 1.0 / 240;
    state.positions.push_back(Vec3::Zero());
    state.velocities.push_back(velocity);
    state.previous_velocities.push_back(velocity - state.previous_dt * acceleration);
  }
  int level(const StepControl& control = {}, Effort effort = Effort::normal) const {
    return control.choose(parts, loads, masses, state, frame, effort);
  }
};

TEST(StepControl, BodyAtRestTakesOneStepPerFrame) {
  Moving still;
  still.add(Vec3::Zero(), Vec3::Zero());
  EXPECT_EQ(still.level(), 0);
  Moving drifting;
  drifting.add(Vec3(30, 0, 0), Vec3::Zero());
  EXPECT_EQ(drifting.level(), 0) << "alone a velocity is nothing";
}

TEST(StepControl, AccelerationAndSizeBoundTheStepForAnyEdges) {
  for (const double a : {1.0, 9.81, 40.0, 160.0}) {
    Moving moving;
    moving.add(Vec3::Zero(), Vec3(0, -a, 0));
    const int level = moving.level();
    const double dt = frame / (1 << level);
    EXPECT_LE(a * dt * dt, 3.5e-4 * (1 + 1e-9));
    if (level > 0) {
      EXPECT_GT(a * 4 * dt * dt, 3.5e-4) << "no shorter than need be";
    }
    moving.parts.edges[0] = 0.002;
    EXPECT_EQ(moving.level(), level);
    moving.parts.sizes[0] = 4;
    EXPECT_EQ(moving.level(), std::max(level - 1, 0));
  }
}

TEST(StepControl, DraftsTakeStepsTwiceAsLong) {
  Moving moving;
  moving.add(Vec3::Zero(), Vec3(0, -40, 0));
  EXPECT_EQ(moving.level({}, Effort::draft), moving.level() - 1);
}

TEST(StepControl, MeetingPartsMoveAFewEdgesPerStep) {
  Moving moving;
  moving.add(Vec3(20, 0, 0), Vec3::Zero());
  moving.add(Vec3(-20, 0, 0), Vec3::Zero());
  const int level = moving.level();
  EXPECT_LE(40 * frame / (1 << level), 4 * 0.02);
  EXPECT_GT(40 * frame / (1 << level), 2 * 0.02);
}

TEST(StepControl, HardStepsShortenAndEasyStepsLengthenTheNext) {
  Moving moving;
  moving.add(Vec3::Zero(), Vec3(0, -9.81, 0));
  const int level = moving.level();
  StepControl control;
  StepReport hard, easy, missed;
  hard.converged = easy.converged = true;
  hard.newton_iterations = 100;
  easy.newton_iterations = 1;
  control.note(level, hard);
  EXPECT_EQ(moving.level(control), level + 1);
  control.note(level + 1, missed);
  EXPECT_EQ(moving.level(control), level + 2);
  control.note(level + 2, hard);
  EXPECT_EQ(moving.level(control), level + 2) << "no more than four times as short";
  control.note(level + 2, easy);
  EXPECT_EQ(moving.level(control), level + 1);
  control.note(level + 1, easy);
  EXPECT_EQ(moving.level(control), level);
}

TEST(StepControl, StepsEndTogetherWithFramesAndGrowByTwoAtMost) {
  Moving still;
  still.add(Vec3::Zero(), Vec3::Zero());
  StepControl control;
  control.level = 3;
  EXPECT_EQ(still.level(control), 2);
  control.ticks = StepControl::length(3);
  EXPECT_EQ(still.level(control), 3) << "an eighth of the frame is done: a quarter does not fit";
  control.ticks = 3 * StepControl::length(2);
  EXPECT_EQ(still.level(control), 2);
}

}  // namespace
}  // namespace muslin
