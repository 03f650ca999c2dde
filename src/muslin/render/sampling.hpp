// Generates evenly spread sample points, the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Core>

namespace muslin::sampling {

/// Returns point number `index` in [0, 1)² of a sequence of multiples of two irrational numbers, given in
/// units of 2⁻³² (Roberts 2018: inverse powers of the root of gᵈ⁺¹ = g + 1 fill d dimensions evenly).
/// Integers wrap around without loss at any index.
inline Eigen::Vector2f multiples(std::uint32_t index, std::uint32_t step_x, std::uint32_t step_y) {
  const std::uint32_t a = 0x80000000u + index * step_x;
  const std::uint32_t b = 0x80000000u + index * step_y;
  return {static_cast<float>(a >> 8) * 0x1p-24f, static_cast<float>(b >> 8) * 0x1p-24f};
}
// Four dimensions for a camera ray and its sun rays, two for its sky rays.
inline Eigen::Vector2f pixel_point(std::uint32_t index) { return multiples(index, 3679390609u, 3152041523u); }
inline Eigen::Vector2f sun_point(std::uint32_t index) { return multiples(index, 2700274807u, 2313257605u); }
inline Eigen::Vector2f sky_point(std::uint32_t index) { return multiples(index, 3242174889u, 2447445415u); }

/// Returns the place of a pixel along the Hilbert curve through its 64 × 64 block. With samples numbered
/// along the curve, neighbouring pixels use consecutive points of the sequences, which makes the noise
/// fine-grained instead of clumped.
inline std::uint32_t hilbert(std::uint32_t x, std::uint32_t y) {
  std::uint32_t index = 0;
  for (std::uint32_t side = 32; side > 0; side /= 2) {
    const std::uint32_t right = (x & side) != 0;
    const std::uint32_t down = (y & side) != 0;
    index += side * side * ((3 * right) ^ down);
    if (down == 0) {
      if (right == 1) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return index;
}

/// Area-preserving map of the square to the unit disc, rings to circles (Shirley and Chiu 1997).
inline Eigen::Vector2f disc(const Eigen::Vector2f& square) {
  const float a = 2 * square.x() - 1;
  const float b = 2 * square.y() - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr float quarter = 0.78539816f;
  const bool wide = std::abs(a) > std::abs(b);
  const float radius = wide ? a : b;
  const float angle = wide ? quarter * (b / a) : 2 * quarter - quarter * (a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Returns −1…1 with the density of a tent, from uniform 0…1: the pixel filter.
inline float tent(float u) { return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u); }

/// Computes two unit vectors at right angles to the unit vector n and to each other (Duff et al. 2017).
inline void basis(const Eigen::Vector3f& n, Eigen::Vector3f& s, Eigen::Vector3f& t) {
  const float sign = std::copysign(1.0f, n.z());
  const float a = -1 / (sign + n.z());
  const float b = n.x() * n.y() * a;
  s = {1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
  t = {b, sign + n.y() * n.y() * a, -n.y()};
}

}  // namespace muslin::sampling
