#include "muslin/render/colour.hpp"

#include <algorithm>
#include <cmath>

namespace muslin {
namespace {

constexpr float shoulder = 0.6f;  // where the tone curve leaves the straight line

double decode(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
double encode(double l) { return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055; }

/// OKLab to linear sRGB (B. Ottosson, "A perceptual color space for image processing", 2020).
Light linear_of_oklab(const Vec3& lab) {
  const double l = std::pow(lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2], 3);
  const double m = std::pow(lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2], 3);
  const double s = std::pow(lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2], 3);
  return Vec3(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
              -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
              -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)
      .cast<float>();
}

// (L, a, b) at even steps of t; L is a straight line in each map (two lines in the diverging one).
const std::array<Vec3, 6> sequential_path = {Vec3(0.300, 0.045, -0.105),  Vec3(0.425, -0.010, -0.105),
                                             Vec3(0.550, -0.075, -0.045), Vec3(0.675, -0.120, 0.040),
                                             Vec3(0.800, -0.105, 0.125),  Vec3(0.925, -0.030, 0.165)};
const std::array<Vec3, 5> diverging_path = {Vec3(0.46, -0.030, -0.150), Vec3(0.69, -0.030, -0.080),
                                            Vec3(0.92, 0.000, 0.000), Vec3(0.69, 0.090, 0.060),
                                            Vec3(0.46, 0.160, 0.080)};

template <std::size_t N>
Vec3 along(const std::array<Vec3, N>& path, double t) {
  const double place = t * static_cast<double>(N - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), N - 2);
  const double s = place - static_cast<double>(i);
  return (1 - s) * path[i] + s * path[i + 1];
}

}  // namespace

Light linear_of_srgb(const Vec3& srgb) {
  return Vec3(decode(srgb[0]), decode(srgb[1]), decode(srgb[2])).cast<float>();
}

Vec3 srgb_of_linear(const Light& light) {
  Vec3 srgb;
  for (int i = 0; i < 3; ++i) srgb[i] = encode(std::clamp(static_cast<double>(light[i]), 0.0, 1.0));
  return srgb;
}

Light tone_curve(const Light& radiance) {
  Light shown;
  for (int i = 0; i < 3; ++i) {
    const float x = radiance[i];
    shown[i] =
        x <= shoulder ? std::max(x, 0.0f) : 1 - (1 - shoulder) * std::exp(-(x - shoulder) / (1 - shoulder));
  }
  return shown;
}

Light inverse_tone_curve(const Light& shown) {
  Light radiance;
  for (int i = 0; i < 3; ++i) {
    const float y = std::min(shown[i], 0.999f);
    radiance[i] = y <= shoulder ? y : shoulder - (1 - shoulder) * std::log((1 - y) / (1 - shoulder));
  }
  return radiance;
}

std::array<std::uint8_t, 3> bytes_of_srgb(const Vec3& srgb) {
  std::array<std::uint8_t, 3> bytes;
  for (std::size_t i = 0; i < 3; ++i)
    bytes[i] = static_cast<std::uint8_t>(
        std::lround(255 * std::clamp(srgb[static_cast<Eigen::Index>(i)], 0.0, 1.0)));
  return bytes;
}

Vec3 map_colour(ColourMap map, double t) {
  t = t > 0 ? std::min(t, 1.0) : 0;  // also takes NaN to 0
  return srgb_of_linear(
      linear_of_oklab(map == ColourMap::sequential ? along(sequential_path, t) : along(diverging_path, t)));
}

}  // namespace muslin
