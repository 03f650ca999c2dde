#include "muslin/force/gusts.hpp"

#include <array>
#include <cmath>

#include "muslin/force/split_mix.hpp"

namespace muslin {

namespace {

/// Three numbers in [−1, 1) from 21 bits each.
Vec3 unpack(std::uint64_t bits) {
  constexpr std::uint64_t mask = (1u << 21) - 1;
  constexpr double scale = 2.0 / (1u << 21);
  return Vec3(static_cast<double>(bits & mask), static_cast<double>(bits >> 21 & mask),
              static_cast<double>(bits >> 42 & mask)) *
             scale -
         Vec3::Ones();
}

/// One octave: random values at the integer points of space-time, blended by 6t⁵ − 15t⁴ + 10t³.
Vec3 octave(const Eigen::Vector4d& p, std::uint64_t seed) {
  std::array<std::array<std::uint64_t, 2>, 4> cell;
  std::array<std::array<double, 2>, 4> weight;
  for (int d = 0; d < 4; ++d) {
    const double base = std::floor(p[d]);
    const double t = p[d] - base;
    const auto lower = static_cast<std::uint64_t>(static_cast<std::int64_t>(base));
    const double blend = t * t * t * (t * (t * 6 - 15) + 10);
    cell[static_cast<std::size_t>(d)] = {lower, lower + 1};
    weight[static_cast<std::size_t>(d)] = {1 - blend, blend};
  }
  Vec3 result = Vec3::Zero();
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint64_t hi = split_mix(seed ^ cell[0][i]);
    for (std::size_t j = 0; j < 2; ++j) {
      const std::uint64_t hj = split_mix(hi ^ cell[1][j]);
      for (std::size_t k = 0; k < 2; ++k) {
        const std::uint64_t hk = split_mix(hj ^ cell[2][k]);
        const double w = weight[0][i] * weight[1][j] * weight[2][k];
        for (std::size_t l = 0; l < 2; ++l) result += w * weight[3][l] * unpack(split_mix(hk ^ cell[3][l]));
      }
    }
  }
  return result;
}

}  // namespace

Vec3 gust_noise(const Vec3& place, double time, std::uint64_t seed) {
  // The variance of a uniform number in [−1, 1] is 1/3; blending keeps the share 181/231 of it per dimension
  // (the mean of b² + (1−b)² over the interpolant b). The second octave, at half size, has half the
  // amplitude.
  constexpr double kept = 181.0 / 231.0;
  static const double scale = 1 / std::sqrt((1 + 0.25) / 3 * kept * kept * kept * kept);
  const Eigen::Vector4d p(place.x(), place.y(), place.z(), time);
  return scale * (octave(p, split_mix(seed)) + 0.5 * octave(2 * p, split_mix(split_mix(seed))));
}

}  // namespace muslin
