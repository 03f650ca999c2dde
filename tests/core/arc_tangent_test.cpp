// The arc tangent for vector code against the standard library's.
#include "muslin/core/arc_tangent.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace muslin {
namespace {

TEST(ArcTangent, AgreesWithTheStandardLibrary) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> angle(-3.141592653589793, 3.141592653589793), exponent(-18, 0);
  for (int i = 0; i < 200000; ++i) {
    const double all_around = angle(engine), nearly_flat = std::pow(10, exponent(engine));
    const double length = std::pow(10, 10 * exponent(engine));
    for (const double a : {all_around, nearly_flat, 3.141592653589793 - nearly_flat, -nearly_flat}) {
      const double y = length * std::sin(a), x = length * std::cos(a);
      const double expected = std::atan2(y, x);
      ASSERT_NEAR(arc_tangent(y, x), expected, 4.5e-16 * std::max(std::abs(expected), 1e-300))
          << y << ' ' << x;
    }
  }
}

TEST(ArcTangent, IsExactOnTheAxesAndKeepsNaN) {
  EXPECT_EQ(arc_tangent(0, 0), 0);
  EXPECT_EQ(arc_tangent(0, 2), 0);
  EXPECT_EQ(arc_tangent(3, 0), std::atan2(3, 0));
  EXPECT_EQ(arc_tangent(-3, 0), std::atan2(-3, 0));
  EXPECT_EQ(arc_tangent(0, -1), std::atan2(0, -1));
  EXPECT_EQ(arc_tangent(1, 1), std::atan2(1, 1));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(arc_tangent(nan, 1)));
  EXPECT_TRUE(std::isnan(arc_tangent(1, nan)));
}

}  // namespace
}  // namespace muslin
