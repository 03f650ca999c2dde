// Keyed values interpolate between keys and stay constant outside; windows give exact impulses.
#include "muslin/force/keyed.hpp"

#include <cmath>
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

TEST(Keyed, StepHoldsItsValueUntilTheNextKeyIsReached) {
  const Keyed keyed{{{1, Vec3(1, 0, 0), Interpolation::step}, {2, Vec3(4, 0, 0)}, {3, Vec3(6, 0, 0)}}};
  EXPECT_EQ(keyed.at(1.999), Vec3(1, 0, 0));
  EXPECT_EQ(keyed.at(2), Vec3(4, 0, 0));
  EXPECT_EQ(keyed.at(2 - 1e-12), Vec3(4, 0, 0)) << "rounding of the clock delays no key";
  EXPECT_EQ(keyed.at(2.5), Vec3(5, 0, 0));
}

TEST(Keyed, SmoothHasARateWithoutJumpsAndNeverOvershoots) {
  const Keyed keyed{{{0, Vec3(1, 0, 0), Interpolation::smooth},
                     {1, Vec3(3, 0, 0), Interpolation::smooth},
                     {3, Vec3(-2, 0, 0), Interpolation::smooth}}};
  EXPECT_EQ(keyed.at(0.5), Vec3(2, 0, 0));
  const double h = 1e-4;
  double before = 0;
  for (double t = -0.2; t < 3.2; t += h) {
    const double value = keyed.at(t).x(), rate = (keyed.at(t + h).x() - value) / h;
    EXPECT_GE(value, t < 1 ? 1 : -2) << t;
    EXPECT_LE(value, 3) << t;
    EXPECT_LT(std::abs(rate - before), 13 * h) << t << ": the second derivative is 12 at most";
    before = rate;
  }
}

TEST(Keyed, IntegralIsTheSumOfFineMidpoints) {
  for (const Interpolation way : {Interpolation::linear, Interpolation::step, Interpolation::smooth}) {
    const Keyed keyed{{{-1, Vec3(2, 0, 0), way}, {1, Vec3(4, 0, 1), way}, {2.5, Vec3(-3, 8, 0)}}};
    KeyedNumber number;
    for (const Keyed::Key& key : keyed.keys)
      number.keys.push_back({key.time, key.value[0], key.interpolation});
    for (double end : {0.0, 0.4, 1.0, 2.0, 2.5, 4.0}) {
      Vec3 sum = Vec3::Zero();
      const int n = 4000;
      for (int i = 0; i < n; ++i) sum += end / n * keyed.at((i + 0.5) * end / n);
      EXPECT_LT((keyed.integral(end) - sum).norm(), 1e-5) << end;
      EXPECT_EQ(number.integral(end), keyed.integral(end)[0]);
    }
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
