// Converts between sRGB and linear light, applies the tone curve, and maps numbers to colours.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Linear light (radiance or reflectance), red, green, blue.
using Light = Eigen::Vector3f;

/// Convert sRGB 0…1 to linear light and back (IEC 61966-2-1).
Light linear_of_srgb(const Vec3& srgb);
Vec3 srgb_of_linear(const Light& light);

/// Applies the tone curve: linear up to 0.6, then a shoulder that approaches 1, so that highlights never clip
/// and darker colours stay as the user chose them.
Light tone_curve(const Light& radiance);
/// Returns the radiance that tone_curve maps to `shown` (each below 1).
Light inverse_tone_curve(const Light& shown);

std::array<std::uint8_t, 3> bytes_of_srgb(const Vec3& srgb);

enum class ColourMap {
  sequential,  ///< indigo, teal, green, yellow: lightness rises evenly
  diverging,   ///< blue, light grey, red: lightness falls evenly to both sides of the middle
};

/// Returns the sRGB colour of t in 0…1 (clamped). The map is piecewise linear in OKLab (Ottosson 2020), where
/// equal steps look equal.
Vec3 map_colour(ColourMap map, double t);

/// Colour scale of per-vertex numbers, with the text of the legend.
struct ColourScale {
  double low = 0;
  double high = 1;
  std::string label;  ///< with the unit, such as "stretch [%]"
  ColourMap map = ColourMap::sequential;

  double fraction(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
};

}  // namespace muslin
