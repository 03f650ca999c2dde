#include "muslin/lattice/fill.hpp"

#include <cmath>

namespace muslin {
namespace {

double share(const SignedDistance& distance, const Vec3& centre, double width, int levels) {
  if (levels == 0) return distance.inside(centre) ? 1 : 0;
  const double value = distance(centre);
  if (std::abs(value) > 0.5 * std::sqrt(3.0) * width) return value < 0 ? 1 : 0;
  double sum = 0;
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3 direction(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
    sum += share(distance, centre + 0.25 * width * direction, 0.5 * width, levels - 1);
  }
  return sum / 8;
}

}  // namespace

double sampled_fill(const SignedDistance& distance, const Vec3& centre, double width) {
  return share(distance, centre, width, 3);
}

}  // namespace muslin
