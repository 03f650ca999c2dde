// Colours go there and back, and maps rise evenly in lightness.
#include "muslin/render/colour.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace muslin {
namespace {

double luminance(const Vec3& srgb) {
  return linear_of_srgb(srgb).cast<double>().dot(Vec3(0.2126, 0.7152, 0.0722));
}

TEST(Colour, SrgbAndToneCurveInvert) {
  for (const double x : {0.0, 0.02, 0.2, 0.5, 0.8, 0.95}) {
    const Vec3 colour(x, 0.3, 0.9);
    const Light light = linear_of_srgb(colour);
    EXPECT_LT((srgb_of_linear(light) - colour).norm(), 1e-6);
    EXPECT_LT((tone_curve(inverse_tone_curve(light)) - light).norm(), 1e-5);
  }
  EXPECT_LT(tone_curve(Light::Constant(50)).maxCoeff(), 1.0001f);
  EXPECT_GT(tone_curve(Light::Constant(0.9f)).x(), tone_curve(Light::Constant(0.8f)).x());
}

TEST(Colour, SequentialMapRises) {
  double before = -1;
  for (int i = 0; i <= 100; ++i) {
    const Vec3 colour = map_colour(ColourMap::sequential, i / 100.0);
    const double lightness = std::cbrt(luminance(colour));
    EXPECT_GT(lightness, before) << i;
    before = lightness;
  }
  EXPECT_EQ(map_colour(ColourMap::sequential, -3), map_colour(ColourMap::sequential, 0));
  EXPECT_EQ(map_colour(ColourMap::sequential, NAN), map_colour(ColourMap::sequential, 0));
}

TEST(Colour, DivergingMapIsLightestInTheMiddleAndBalanced) {
  const double middle = luminance(map_colour(ColourMap::diverging, 0.5));
  for (const double t : {0.0, 0.2, 0.4}) {
    const double low = luminance(map_colour(ColourMap::diverging, t));
    const double high = luminance(map_colour(ColourMap::diverging, 1 - t));
    EXPECT_LT(low, middle);
    EXPECT_NEAR(std::cbrt(low), std::cbrt(high), 0.05);
  }
}

}  // namespace
}  // namespace muslin
