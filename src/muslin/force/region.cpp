#include "muslin/force/region.hpp"

#include <algorithm>
#include <limits>

namespace muslin {

double Region::weight(const Vec3& x) const {
  double depth = std::numeric_limits<double>::infinity();
  if (box) depth = std::min((x - box->min).minCoeff(), (box->max - x).minCoeff());
  if (sphere) depth = std::min(depth, sphere->radius - (x - sphere->center).norm());
  if (cylinder) {
    const Vec3 along = cylinder->to - cylinder->from;
    const double length = along.norm();
    const Vec3 axis = along / length;
    const Vec3 offset = x - cylinder->from;
    const double height = axis.dot(offset);
    depth = std::min({depth, height, length - height, cylinder->radius - (offset - height * axis).norm()});
  }
  if (plane) depth = std::min(depth, plane->normal.dot(x - plane->point));
  if (depth < 0) return 0;
  if (depth >= fade) return 1;
  const double t = depth / fade;
  return t * t * (3 - 2 * t);
}

}  // namespace muslin
