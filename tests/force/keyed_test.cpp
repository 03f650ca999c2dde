// Keyed values interpolate linearly and stay constant outside; windows give exact impulses.
#include "muslin/force/keyed.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace muslin {
namespace {

TEST(Keyed, OneKeyIsConstant) {
  const Keyed keyed{{{3.0, Vec3(1, 2, 3)}}};
  for (double t : {-1.0, 3.0, 10.0}) EXPECT_EQ(keyed.at(t), Vec3(1, 2, 3));
}

TEST(Keyed, LinearBetweenKeysConstantOutside) {
  const Keyed keyed{{{1, Vec3(0, 0, 0)}, {2, Vec3(4, 0, 0)}, {4, Vec3(4, 8, 0)}}};
  EXPECT_EQ(keyed.at(0), Vec3(0, 0, 0));
  EXPECT_EQ(keyed.at(1.25), Vec3(1, 0, 0));
  EXPECT_EQ(keyed.at(2), Vec3(4, 0, 0));
  EXPECT_EQ(keyed.at(3), Vec3(4, 4, 0));
  EXPECT_EQ(keyed.at(9), Vec3(4, 8, 0));
}

TEST(Keyed, IntegralIsTheSumOfFineMidpoints) {
  const Keyed keyed{{{-1, Vec3(2, 0, 0)}, {1, Vec3(4, 0, 1)}, {2.5, Vec3(-3, 8, 0)}}};
  for (double end : {0.0, 0.4, 1.0, 2.0, 2.5, 4.0}) {
    Vec3 sum = Vec3::Zero();
    const int n = 4000;
    for (int i = 0; i < n; ++i) sum += end / n * keyed.at((i + 0.5) * end / n);
    EXPECT_LT((keyed.integral(end) - sum).norm(), 1e-5) << end;
  }
}

TEST(Window, SharesOfAllStepsAddUpToItsLength) {
  const Window window{0.333, 1.777};
  for (double dt : {0.5, 0.1, 1.0 / 240, 3.0}) {
    double sum = 0;
    for (int i = 0; i * dt < 4; ++i) sum += dt * window.share(i * dt, (i + 1) * dt);
    EXPECT_NEAR(sum, 1.444, 1e-5 * dt * 2) << dt;
  }
}

TEST(Window, RoundingOfTheClockIsSnapped) {
  double time = 0;
  for (int i = 0; i < 10; ++i) time += 0.1;
  ASSERT_NE(time, 1.0);
  const Window window{1.0, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(window.share(time - 0.1, time), 0);
  EXPECT_EQ(window.share(time, time + 0.1), 1);
}

}  // namespace
}  // namespace muslin
