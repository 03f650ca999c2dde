// Pins hold, move, overlap and let go at the right moment, and remember only what Holds stores.
#include "muslin/constraint/holds.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace muslin {
namespace {

constexpr double pi = std::numbers::pi;

Eigen::Quaterniond turn(double degrees, const Vec3& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * pi / 180, axis));
}

struct Stepper {
  std::vector<Pin> pins;
  std::vector<Vec3> x;
  Holds holds;
  std::vector<std::uint8_t> fixed = std::vector<std::uint8_t>(x.size());
  std::vector<Vec3> targets = std::vector<Vec3>(x.size());

  /// Free vertices drift by (0,−1,0) per second.
  void step(double begin, double end) {
    holds.step(pins, begin, end, x, fixed, targets);
    for (std::size_t v = 0; v < x.size(); ++v) x[v] = fixed[v] ? targets[v] : x[v] - Vec3(0, end - begin, 0);
  }
};

TEST(Motion, NoKeysIsTheIdentity) { EXPECT_TRUE(Motion{}.at(3).isApprox(Eigen::Isometry3d::Identity())); }

TEST(Motion, TurnsAboutItsPivotAtConstantSpeed) {
  Motion motion;
  motion.pivot = Vec3(1, 0, 0);
  motion.keys = {{0, Vec3::Zero(), turn(0, Vec3::UnitZ())}, {2, Vec3(0, 0, 4), turn(90, Vec3::UnitZ())}};
  EXPECT_LT((motion.at(1) * Vec3(1, 0, 0) - Vec3(1, 0, 2)).norm(), 1e-14);
  const double c = std::sqrt(0.5);
  EXPECT_LT((motion.at(1) * Vec3(2, 0, 0) - Vec3(1 + c, c, 2)).norm(), 1e-14);
  EXPECT_LT((motion.at(2) * Vec3(2, 0, 0) - Vec3(1, 1, 4)).norm(), 1e-14);
  EXPECT_TRUE(motion.at(-1).isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(motion.at(5).isApprox(motion.at(2)));
  for (double t : {0.2, 0.7, 1.3}) {
    const Mat3 r = motion.at(t).linear();
    EXPECT_LT((r.transpose() * r - Mat3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(Eigen::AngleAxisd(r).angle(), t * pi / 4, 1e-14);
  }
}

TEST(Holds, PinActiveAtTheEndOfTheStepHolds) {
  Stepper s{{{"a", {1}, 0.5, 1.5, {}}}, {Vec3(0, 0, 0), Vec3(1, 0, 0)}, {}};
  s.step(0, 0.25);
  EXPECT_EQ(s.fixed, (std::vector<std::uint8_t>{0, 0}));
  s.step(0.25, 0.5);  // active at 0.5: stays where it was at 0.25
  EXPECT_EQ(s.fixed, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(s.x[1], Vec3(1, -0.25, 0));
  EXPECT_EQ(s.x[0], Vec3(0, -0.5, 0));
  s.step(0.5, 1.25);
  EXPECT_EQ(s.x[1], Vec3(1, -0.25, 0));
  s.step(1.25, 1.5);  // `until` is not held any more
  EXPECT_EQ(s.fixed[1], 0);
  EXPECT_EQ(s.targets[1], Vec3(1, -0.25, 0));
}

TEST(Holds, RoundingOfTheClockReleasesInTheRightStep) {
  double time = 0;
  for (int i = 0; i < 10; ++i) time += 0.1;  // 0.9999999999999999
  ASSERT_LT(time, 1.0);
  Stepper s{{{"a", {0}, 0, 1, {}}, {"b", {1}, 1, 2, {}}}, {Vec3::Zero(), Vec3::Zero()}, {}};
  s.step(time - 0.1, time);
  EXPECT_EQ(s.fixed, (std::vector<std::uint8_t>{0, 1}));
}

TEST(Holds, LaterPinHasPriorityAndTheEarlierContinuesAfterIt) {
  Motion lift;
  lift.keys = {{0, Vec3::Zero(), turn(0, Vec3::UnitX())}, {1, Vec3(0, 1, 0), turn(0, Vec3::UnitX())}};
  Stepper s{{{"floor", {0}, 0, 10, {}}, {"hand", {0}, 0, 0.9, lift}}, {Vec3(2, 0, 0)}, {}};
  s.step(0, 0.5);
  EXPECT_EQ(s.x[0], Vec3(2, 0.5, 0));
  s.step(0.5, 1.0);
  EXPECT_EQ(s.x[0], Vec3(2, 0, 0));
}

TEST(Holds, KeysAreOffsetsFromTheStartAlsoIfTheFirstIsLaterOrNotAtRest) {
  Motion lift;
  lift.pivot = Vec3(1, 0, 0);
  lift.keys = {{0.5, Vec3(0, 3, 0), turn(90, Vec3::UnitZ()), Vec3(2, 1, 1)},
               {1.5, Vec3(0, 5, 0), turn(90, Vec3::UnitZ()), Vec3(4, 1, 1)}};
  Stepper s{{{"hand", {0}, 0, 10, lift}}, {Vec3(2, 0, 0)}, {}};
  s.step(0, 0.25);  // twice as far from the pivot, turned by a quarter, lifted by 3
  EXPECT_LT((s.x[0] - Vec3(1, 5, 0)).norm(), 1e-14);
  s.step(0.25, 0.5);
  EXPECT_LT((s.x[0] - Vec3(1, 5, 0)).norm(), 1e-14);
  s.step(0.5, 1.5);
  EXPECT_LT((s.x[0] - Vec3(1, 9, 0)).norm(), 1e-14);
}

TEST(Holds, MotionOfALatePinIsRelativeToItsBeginning) {
  Motion rise;
  rise.keys = {{0, Vec3(0, 0, 0), turn(0, Vec3::UnitX())}, {2, Vec3(0, 2, 0), turn(0, Vec3::UnitX())}};
  Stepper s{{{"a", {0}, 1, 10, rise}}, {Vec3(0, 0, 0)}, {}};
  s.step(0, 0.5);
  s.step(0.5, 1);  // takes hold at y = −0.5, where it was at the beginning of the step
  EXPECT_LT((s.x[0] - Vec3(0, -0.5, 0)).norm(), 1e-15);
  s.step(1, 1.5);
  EXPECT_LT((s.x[0] - Vec3(0, 0, 0)).norm(), 1e-15);
}

TEST(Holds, PinThatStartsAgainRecordsNewPositions) {
  Stepper s{{{"a", {0}, 0, 1, {}}, {"b", {0}, 2, 3, {}}}, {Vec3::Zero()}, {}};
  s.step(0, 0.5);
  s.step(0.5, 1.5);
  s.step(1.5, 2.5);
  EXPECT_EQ(s.x[0], Vec3(0, -1, 0));
}

TEST(Holds, CopyContinuesWithTheSameBits) {
  Motion swing;
  swing.pivot = Vec3(0.3, 0.1, 0);
  swing.keys = {{0, Vec3::Zero(), turn(0, Vec3::UnitZ())}, {2, Vec3(1, 2, 3), turn(70, Vec3(0, 0.6, 0.8))}};
  Stepper a{{{"a", {0, 2}, 0.2, 9, swing}}, {Vec3(1, 2, 3), Vec3(0, 0, 0), Vec3(4, 5, 6)}, {}};
  for (int i = 0; i < 5; ++i) a.step(0.1 * i, 0.1 * (i + 1));
  Stepper b{a.pins, a.x, Holds{a.holds.holding, a.holds.anchors}};
  for (int i = 5; i < 9; ++i) a.step(0.1 * i, 0.1 * (i + 1)), b.step(0.1 * i, 0.1 * (i + 1));
  EXPECT_EQ(a.x, b.x);
}

TEST(Holds, FollowsItsPointsWithAConstantOffset) {
  PointSequence sequence{2, {0, 1, 2}, {}};
  for (float t : {0.f, 1.f, 2.f}) {
    sequence.positions.emplace_back(0, t * t, 0);
    sequence.positions.emplace_back(5, 0, -t);
  }
  Pin pin{"hand", {0, 1}, 0, 10, {}};
  pin.sequence = std::make_shared<const PointSequence>(sequence);
  pin.points = {1, 0};
  Pin late = pin;
  late.vertices = {2};
  late.points = {1};
  late.from = 1;
  Stepper s{{pin, late}, {Vec3(5, 0, 0.5), Vec3(0, 0, 0), Vec3(7, 0, 0)}, {}};
  s.step(0, 0.5);
  EXPECT_EQ(s.x[0], Vec3(5, 0, 0));
  EXPECT_EQ(s.x[1], Vec3(0, 0.5, 0));
  EXPECT_EQ(s.x[2], Vec3(7, -0.5, 0));
  s.step(0.5, 1);  // the late one takes hold where it was at 0.5, when its point was at z = −0.5
  EXPECT_EQ(s.x[2], Vec3(7, -0.5, -0.5));
  s.step(1, 1.5);
  EXPECT_EQ(s.x[0], Vec3(5, 0, -1));
  EXPECT_EQ(s.x[1], Vec3(0, 2.5, 0));
  EXPECT_EQ(s.x[2], Vec3(7, -0.5, -1));
  // Put elsewhere by hand, they keep their new distance from their points.
  for (Vec3& x : s.x) x += Vec3(0, 0, 10);
  s.holds.reanchor(s.pins, 1.5, s.x);
  s.step(1.5, 2);
  EXPECT_EQ(s.x[0], Vec3(5, 0, 8.5));
  EXPECT_EQ(s.x[1], Vec3(0, 4, 10));
  EXPECT_EQ(s.x[2], Vec3(7, -0.5, 8.5));
}

TEST(Holds, ReanchorHoldsMovedVerticesAndContinuesTheMotion) {
  Motion lift;
  lift.keys = {{0, Vec3::Zero(), turn(0, Vec3::UnitZ())}, {2, Vec3(0, 2, 0), turn(90, Vec3::UnitZ())}};
  Stepper s{{{"turned", {0}, 0, 9, lift}, {"still", {1}, 0, 9, {}}, {"late", {2}, 1, 9, {}}},
            {Vec3(1, 0, 0), Vec3(5, 0, 0), Vec3(0, 0, 0)},
            {}};
  s.holds.reanchor(s.pins, 0, s.x);  // before the first step nothing holds yet
  s.step(0, 0.5);
  s.x = {Vec3(3, 0, 0), Vec3(5, 7, 0), Vec3(8, 0, 0)};
  s.holds.reanchor(s.pins, 0.5, s.x);
  s.step(0.5, 1);
  const Eigen::Isometry3d moved = lift.at(1) * lift.at(0.5).inverse();
  EXPECT_LT((s.x[0] - moved * Vec3(3, 0, 0)).norm(), 1e-14);
  EXPECT_EQ(s.x[1], Vec3(5, 7, 0));
  EXPECT_EQ(s.x[2], Vec3(8, 0, 0));
}

}  // namespace
}  // namespace muslin
