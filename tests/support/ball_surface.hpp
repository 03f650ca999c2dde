// A ball of triangles, closed or open at its top.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin::test {

struct Surface {
  std::vector<Vec3> x;
  std::vector<Vec3i> triangles;
};

/// A ball of `rings` rings and twice as many segments; `open` leaves out the upper cap.
inline Surface ball(int rings, double radius, bool open = false, const Vec3& centre = Vec3::Zero()) {
  Surface s;
  const int segments = 2 * rings;
  s.x.push_back(centre - radius * Vec3::UnitY());
  for (int r = 1; r < rings; ++r) {
    const double polar = std::numbers::pi * (static_cast<double>(r) / rings - 0.5);
    for (int k = 0; k < segments; ++k) {
      const double turn = 2 * std::numbers::pi * k / segments;
      s.x.push_back(centre + radius * Vec3(std::cos(polar) * std::cos(turn), std::sin(polar),
                                           -std::cos(polar) * std::sin(turn)));
    }
  }
  const auto at = [&](int r, int k) { return 1 + (r - 1) * segments + k % segments; };
  for (int k = 0; k < segments; ++k) s.triangles.emplace_back(0, at(1, k + 1), at(1, k));
  for (int r = 1; r + 1 < rings; ++r) {
    for (int k = 0; k < segments; ++k) {
      s.triangles.emplace_back(at(r, k), at(r, k + 1), at(r + 1, k + 1));
      s.triangles.emplace_back(at(r, k), at(r + 1, k + 1), at(r + 1, k));
    }
  }
  if (open) return s;
  s.x.push_back(centre + radius * Vec3::UnitY());
  const int top = static_cast<int>(s.x.size()) - 1;
  for (int k = 0; k < segments; ++k) s.triangles.emplace_back(at(rings - 1, k), at(rings - 1, k + 1), top);
  return s;
}

}  // namespace muslin::test
