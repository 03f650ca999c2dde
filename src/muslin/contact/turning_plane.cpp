#include "muslin/contact/turning_plane.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/contact/conservative_advancement.hpp"

namespace muslin {
namespace {

/// Returns true if x + s u keeps the distance for all s in [0, t]: with N(s) = (b − a) × (c − a), quadratic
/// in s, and D(s) = N·(x − a), cubic, d = D/|N|. A polynomial lies within the hull of its Bernstein
/// coefficients, so d ≥ min Dₖ / max |Nₖ| wherever min Dₖ ≥ 0.
bool keeps(std::span<const Vec3, 4> x, std::span<const Vec3, 4> u, double t, double required) {
  const auto apart = [&](std::size_t i, double s) { return Vec3(x[i] - x[1] + s * (u[i] - u[1])); };
  const Vec3 b0 = apart(2, 0), b1 = apart(2, t), c0 = apart(3, 0), c1 = apart(3, t);
  const Vec3 p0 = apart(0, 0), p1 = apart(0, t);
  const std::array<Vec3, 3> n = {b0.cross(c0), (b0.cross(c1) + b1.cross(c0)) / 2, b1.cross(c1)};
  const double least = std::min({n[0].dot(p0), (n[0].dot(p1) + 2 * n[1].dot(p0)) / 3,
                                 (2 * n[1].dot(p1) + n[2].dot(p0)) / 3, n[2].dot(p1)});
  return least >=
         required * std::sqrt(std::max({n[0].squaredNorm(), n[1].squaredNorm(), n[2].squaredNorm()}));
}

}  // namespace

OverPlane over_plane(std::span<const Vec3, 4> x) {
  const Vec3 u = x[2] - x[1], v = x[3] - x[1], w = x[0] - x[1], n = u.cross(v);
  const double area = n.norm();
  if (!(area > 0)) return {};
  const double s = w.cross(v).dot(n) / (area * area), t = u.cross(w).dot(n) / (area * area);
  return {n / area, n.dot(w) / area, {1, -(1 - s - t), -s, -t}};
}

double safe_fraction_over_plane(std::span<const Vec3, 4> x, std::span<const Vec3, 4> u, double required) {
  double size = 0;
  for (std::size_t i = 0; i < 4; ++i)
    size = std::max({size, x[i].cwiseAbs().maxCoeff(), u[i].cwiseAbs().maxCoeff()});
  const double floor = required + distance_rounding(size);
  if (keeps(x, u, 1, floor)) return 1;
  constexpr int bits = 40;
  double safe = 0;
  for (double step = 0.5; step > std::ldexp(1.0, -bits); step /= 2)
    if (keeps(x, u, safe + step, floor)) safe += step;
  return safe;
}

}  // namespace muslin
