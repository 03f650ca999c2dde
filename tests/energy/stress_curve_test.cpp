// Curves through points: exact there, rising, smooth, close to the curve that the points are taken from; the
// Poisson ratios that curves allow.
#include "muslin/energy/stress_curve.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "muslin/energy/sheet_stress.hpp"

namespace muslin {
namespace {

const std::vector<std::vector<Vec2>> shapes = {
    {{0.1, 30}},
    {{0.02, 1}, {0.04, 10}, {0.06, 100}, {0.08, 190}, {0.1, 280}},  // a toe, then straight
    {{0.01, 50}, {0.05, 60}, {0.1, 62}, {0.2, 200}},                // soft, then stiff
    {{0.01, 100}, {0.2, 101}, {0.3, 101.5}},                        // yields
    {{1e-6, 1e-3}, {0.01, 1}, {0.1, 1e3}, {3, 1e5}, {3.001, 1e5 + 1e3}},
};

TEST(StressCurve, MeetsItsPoints) {
  for (const auto& points : shapes) {
    const StressCurve curve(points);
    EXPECT_EQ(curve.stress(0), 0);
    for (const Vec2& point : points) EXPECT_NEAR(curve.stress(point[0]) / point[1], 1, 1e-12);
  }
}

TEST(StressCurve, RisesEverywhereAndItsEnergyHasContinuousSecondDerivatives) {
  for (const auto& points : shapes) {
    const StressCurve curve(points);
    double least = curve.slope(-0.3), greatest = least, energy = 0, from = 0;
    std::vector<Vec2> ends = points;
    ends.push_back(2 * points.back());
    for (const Vec2& end : ends) {
      constexpr int steps = 1000;
      const double step = (end[0] - from) / steps;
      for (int i = 0; i < steps; ++i) {
        const double x = from + i * step;
        least = std::min(least, curve.slope(x));
        greatest = std::max(greatest, curve.slope(x));
        // The integral over a step by Simpson's rule, which is exact for quadratics.
        energy += step / 6 * (curve.stress(x) + 4 * curve.stress(x + step / 2) + curve.stress(x + step));
        EXPECT_NEAR(curve.energy(x + step), energy, 1e-6 * energy) << x;
        // A jump of the slope between both ends of a step would show in its chord.
        const double chord = (curve.stress(x + step) - curve.stress(x)) / step;
        EXPECT_NEAR(chord, curve.slope(x), 0.01 * curve.greatest_slope()) << x;
        EXPECT_NEAR(chord, curve.slope(x + step), 0.01 * curve.greatest_slope()) << x;
      }
      from = end[0];
    }
    EXPECT_GT(least, 0);
    EXPECT_GE(least, curve.least_slope() * (1 - 1e-12));
    EXPECT_LE(greatest, curve.greatest_slope() * (1 + 1e-12));
  }
}

TEST(StressCurve, GoesOnStraightOnBothSides) {
  for (const auto& points : shapes) {
    const StressCurve curve(points);
    const double end = points.back()[0], first = curve.slope(0), last = curve.slope(end);
    EXPECT_NEAR(curve.slope(1e3 * end) / last, 1, 1e-9);
    EXPECT_NEAR(curve.stress(1e3 * end) / (points.back()[1] + 999 * end * last), 1, 1e-9);
    EXPECT_NEAR(curve.stress(-0.4) / (-0.4 * first), 1, 1e-12);
    EXPECT_NEAR(curve.energy(-0.4) / (0.08 * first), 1, 1e-12);
  }
}

TEST(StressCurve, IsWithinAThousandthOfASmoothCurve) {
  // Eight points of a cloth that is ten times as stiff at the end as at the beginning.
  const auto smooth = [](double x) { return 50 * x + 1125 * x * x; };
  std::vector<Vec2> points;
  for (int i = 1; i <= 8; ++i) points.emplace_back(0.025 * i, smooth(0.025 * i));
  const StressCurve curve(points);
  for (double x = 0.001; x < 0.2; x += 0.001) EXPECT_NEAR(curve.stress(x) / smooth(x), 1, 1e-3) << x;
}

TEST(StressCurve, IsTheSameByPieces) {
  for (const auto& points : shapes) {
    const StressCurve curve = StressCurve(points).plus(3);
    for (double x = 0; x < 2 * points.back()[0]; x += 0.003) {
      const StressCurve::State state = curve.at(x);
      EXPECT_NEAR(state.energy, curve.energy(x), 1e-12 * (1 + state.energy));
      EXPECT_NEAR(state.stress, curve.stress(x), 1e-12 * (1 + state.stress));
      EXPECT_NEAR(state.slope, curve.slope(x), 1e-12 * curve.greatest_slope());
    }
  }
}

TEST(StressCurve, PlusALineIsTheSum) {
  const StressCurve curve(shapes[2]), sum = curve.plus(70);
  for (const double x : {-0.3, 0.0, 0.004, 0.07, 0.2, 5.0}) {
    EXPECT_NEAR(sum.energy(x), curve.energy(x) + 35 * x * x, 1e-12 * (1 + sum.energy(x)));
    EXPECT_NEAR(sum.stress(x), curve.stress(x) + 70 * x, 1e-12 * (1 + std::abs(sum.stress(x))));
    EXPECT_NEAR(sum.slope(x), curve.slope(x) + 70, 1e-12 * sum.slope(x));
  }
}

TEST(SheetStress, SofteningCurvesAllowSmallPoissonRatiosOnly) {
  const StressCurve stiffens(std::vector<Vec2>{{0.1, 10}, {0.2, 40}});
  const StressCurve softens(std::vector<Vec2>{{0.1, 40}, {0.2, 45}});
  EXPECT_EQ(highest_poisson({stiffens, softens, StressCurve(1)}), 1);
  const double ratio = softens.least_slope() / softens.slope(0);
  // Equal curves: p (1 − ν²) + ν² ≥ ν, the smaller eigenvalue of the moduli.
  EXPECT_NEAR(highest_poisson({softens, softens, StressCurve(1)}), ratio / (1 - ratio), 1e-12);
}

}  // namespace
}  // namespace muslin
