#include "muslin/fit/elastica.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace muslin {
namespace {

double degrees(double angle) { return angle * std::numbers::pi / 180; }

TEST(Elastica, CantileverOfKnownWeight) {
  // Γ = w L³/D = 7.5 drops 0.8368680 times its reach (shooting of another program).
  const double length = cantilever_bending_length(1, std::atan(0.8368680361));
  EXPECT_NEAR(1 / std::pow(length, 3), 7.5, 1e-6);
}

TEST(Elastica, SmallAnglesAreThoseOfABeam) {
  EXPECT_NEAR(cantilever_bending_length(2, std::atan(0.001 / 8)), 2 / std::cbrt(0.001), 1e-4);
}

TEST(Elastica, CantileverTesterNearlyHalvesTheOverhang) {
  // The standards take c = L/2 at 41.5°.
  EXPECT_NEAR(cantilever_bending_length(0.04, degrees(41.5)), 0.02, 0.0003);
}

/// The height of a loop of a strip of length 1 that is too stiff to sag.
double least_height(LoopShape shape) {
  double low = 0, high = 0.48;
  for (int i = 0; i < 16; ++i) {
    const double height = (low + high) / 2;
    try {
      loop_bending_length(shape, 1, height);
      high = height;
    } catch (const Error&) {
      low = height;
    }
  }
  return high;
}

TEST(Elastica, LoopsWithoutWeightAreThoseOfPeirce) {
  EXPECT_NEAR(least_height(LoopShape::ring), 1 / std::numbers::pi, 1e-5);
  EXPECT_NEAR(least_height(LoopShape::pear), 0.4243, 1e-4);
  EXPECT_NEAR(least_height(LoopShape::heart), 0.1337, 3e-4);
}

TEST(Elastica, HeartLoopIsNearlyThatOfPeirce) {
  // c = 0.1337 L (cos θ/tan θ)^(1/3), θ = 32.85° (h − h₀)/h₀: his approximation.
  for (const double height : {0.15, 0.17, 0.2, 0.23}) {
    const double theta = degrees(32.85) * (height - 0.1337) / 0.1337;
    const double peirce = 0.1337 * std::cbrt(std::cos(theta) / std::tan(theta));
    EXPECT_NEAR(loop_bending_length(LoopShape::heart, 1, height), peirce, 0.04 * peirce) << height;
  }
}

TEST(Elastica, LengthsScale) {
  EXPECT_NEAR(loop_bending_length(LoopShape::pear, 0.2, 0.09),
              0.2 * loop_bending_length(LoopShape::pear, 1, 0.45), 1e-9);
}

}  // namespace
}  // namespace muslin
