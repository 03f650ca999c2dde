// A square of cloth as it hangs over a sphere, in closed form: for tests and benchmarks of contact.
#pragma once

#include <cmath>

#include "support/cloth_grid.hpp"

namespace muslin::test {

/// n × n vertices, 1 m × 1 m, over a sphere of 0.25 m about the origin: it follows the sphere to 95° from the
/// top and hangs below in twelve folds.
inline ClothGrid draped_cloth(int n) {
  ClothGrid cloth(n, n, 1.0 / (n - 1));
  const double radius = 0.251, lap = 95 * M_PI / 180;
  for (Vec3& p : cloth.positions) {
    const double x = p.x() - 0.5, z = p.z() - 0.5, along = std::hypot(x, z), around = std::atan2(z, x);
    const double angle = along / radius;
    double out = radius * std::sin(angle), up = radius * std::cos(angle);
    if (angle > lap) {
      const double below = along - radius * lap;
      out = radius * std::sin(lap) + 0.2 * below + 0.15 * below * std::cos(12 * around);
      up = radius * std::cos(lap) - 0.95 * below;
    }
    p = Vec3(out * std::cos(around), up, out * std::sin(around));
  }
  return cloth;
}

}  // namespace muslin::test
