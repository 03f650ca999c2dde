// Stresses of strip and shear tests.
#include "muslin/material/measured_sheet.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace muslin {
namespace {

TEST(MeasuredSheet, StressIsForcePerDeformedLengthOfAStrip) {
  ShellMaterial material;
  material.warp_curve = {{0, 0}, {0.1, 33}, {0.2, 90}};
  material.membrane_weft = 400;
  const SheetStress stress = stress_of(material);
  EXPECT_NEAR(stress.warp.stress(0.5 * (1.1 * 1.1 - 1)), 33 / 1.1, 1e-12);
  EXPECT_NEAR(stress.warp.stress(0.5 * (1.2 * 1.2 - 1)), 90 / 1.2, 1e-12);
  EXPECT_EQ(stress.weft.stress(0.3), 120);
}

TEST(MeasuredSheet, StressOfShearDoesTheWorkOfTheTest) {
  ShellMaterial material;
  material.shear_curve = {{5, 10}, {30, 200}};
  const SheetStress stress = stress_of(material);
  const auto energy = [&](double degrees) {
    return stress.shear.energy(std::sin(degrees * std::numbers::pi / 180));
  };
  for (const Vec2& point : *material.shear_curve) {
    const double d = 1e-4, per_radian = 180 / std::numbers::pi / (2 * d);
    EXPECT_NEAR((energy(point[0] + d) - energy(point[0] - d)) * per_radian / point[1], 1, 1e-6);
  }
}

}  // namespace
}  // namespace muslin
