#include "muslin/force/grid_pattern.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace muslin {

GridPattern::GridPattern(VectorGrid grid, const Vec3& origin, const Vec3& spacing)
    : grid_(std::move(grid)), origin_(origin), spacing_(spacing) {}

FieldSample GridPattern::at(const Vec3& place, double) const {
  const Vec3 p = (place - origin_).cwiseQuotient(spacing_);
  std::array<std::size_t, 3> cell;
  std::array<std::array<double, 2>, 3> weight;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = p[static_cast<Eigen::Index>(axis)];
    const auto last = static_cast<double>(grid_.size[axis] - 1);
    if (!(at >= 0 && at <= last)) return {Vec3::Zero(), place.norm()};
    cell[axis] = std::min(static_cast<std::size_t>(at), grid_.size[axis] - 2);
    const double t = at - static_cast<double>(cell[axis]);
    weight[axis] = {1 - t, t};
  }
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t k = 0; k < 2; ++k)
        sum += weight[0][i] * weight[1][j] * weight[2][k] *
               grid_.vectors[((cell[0] + i) * grid_.size[1] + cell[1] + j) * grid_.size[2] + cell[2] + k];
  return {sum, place.norm()};
}

}  // namespace muslin
