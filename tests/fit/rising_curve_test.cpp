#include "muslin/fit/rising_curve.hpp"

#include <random>

#include <gtest/gtest.h>

#include "muslin/energy/stress_curve.hpp"

namespace muslin {
namespace {

TEST(RisingCurve, PassesThroughFewPointsThatRise) {
  const std::vector<Vec2> points = {{0.01, 2}, {0.02, 6}, {0.04, 25}, {0.05, 31}};
  const RisingCurve fit = fit_rising_curve(points);
  ASSERT_EQ(fit.points.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(fit.points[i][1], points[i][1], 1e-9);
  EXPECT_LT(fit.residual, 1e-9);
}

TEST(RisingCurve, RisesWhereTheDataFall) {
  const RisingCurve fit = fit_rising_curve({{1, 10}, {2, 30}, {3, 20}, {4, 40}});
  ASSERT_EQ(fit.points.size(), 4u);
  EXPECT_NEAR(fit.points[1][1], 25, 0.5);  // the closest that does not fall is their mean
  for (std::size_t i = 1; i < 4; ++i) EXPECT_GT(fit.points[i][1], fit.points[i - 1][1]);
  EXPECT_GT(StressCurve(fit.points).least_slope(), 0);
  EXPECT_NEAR(fit.residual, std::sqrt(50.0 / 3000), 0.01);
}

TEST(RisingCurve, AveragesNoiseOfManySpecimens) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.02);
  const auto exact = [](double x) { return 3000 * x + 4e6 * x * x * x; };
  std::vector<Vec2> data;
  for (int specimen = 0; specimen < 3; ++specimen)
    for (int i = 1; i <= 40; ++i) {
      const double x = 0.05 * i / 40;
      data.emplace_back(x, exact(x) * (1 + noise(random)));
    }
  const RisingCurve fit = fit_rising_curve(data);
  EXPECT_EQ(fit.points.size(), static_cast<std::size_t>(StressCurve::most_points));
  EXPECT_NEAR(fit.residual, 0.02, 0.005);
  const StressCurve curve(fit.points);
  for (double x = 0.005; x <= 0.05; x += 0.001)
    EXPECT_NEAR(curve.stress(x), exact(x), 0.02 * exact(x) + 0.5) << x;
}

TEST(RisingCurve, LeastSquaresStayNonNegative) {
  const std::vector<double> x = non_negative_least_squares({{1, 1}, {1, 2}, {1, 3}}, {3, 2, 1});
  EXPECT_NEAR(x[0], 2, 1e-12);  // without the bound: 4, −1
  EXPECT_EQ(x[1], 0);
}

}  // namespace
}  // namespace muslin
