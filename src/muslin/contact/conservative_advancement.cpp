#include "muslin/contact/conservative_advancement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace muslin {

double safe_fraction(PairKind kind, std::span<const Vec3, 4> x, std::span<const Vec3, 4> u, double required,
                     double tolerance) {
  const int first = first_feature_size(kind);
  double fastest = 0, size = 0;
  for (int i = 0; i < first; ++i) {
    for (int j = first; j < 4; ++j) {
      const auto p = static_cast<std::size_t>(i), q = static_cast<std::size_t>(j);
      fastest = std::max(fastest, (u[p] - u[q]).squaredNorm());
    }
  }
  for (std::size_t i = 0; i < 4; ++i)
    size = std::max({size, x[i].cwiseAbs().maxCoeff(), u[i].cwiseAbs().maxCoeff()});
  fastest = std::sqrt(fastest);
  const double floor = required + distance_rounding(size);

  constexpr int max_steps = 100;
  double t = 0, enough = 0;
  std::array<Vec3, 4> at;
  for (int step = 0; step < max_steps; ++step) {
    for (std::size_t i = 0; i < 4; ++i) at[i] = x[i] + t * u[i];
    const ClosestPoints closest = closest_points(kind, at);
    const double d = closest.distance(), slack = d - floor;
    if (step == 0) enough = std::min(0.1 * slack, tolerance);
    if (slack <= 0 || (step > 0 && slack <= enough)) return t;
    double by_norm = fastest > 0 ? slack / fastest : 2, by_plane = std::numeric_limits<double>::infinity();
    const Vec3 n = closest.difference / d;
    for (int i = 0; i < first; ++i) {
      for (int j = first; j < 4; ++j) {
        const auto p = static_cast<std::size_t>(i), q = static_cast<std::size_t>(j);
        const double rate = n.dot(u[p] - u[q]);
        if (rate < 0) by_plane = std::min(by_plane, (n.dot(at[p] - at[q]) - floor) / -rate);
      }
    }
    const double advance = std::max(by_norm, by_plane) * (1 - 1e-9);
    if (t + advance >= 1) return 1;
    t += advance;
  }
  return t;
}

}  // namespace muslin
