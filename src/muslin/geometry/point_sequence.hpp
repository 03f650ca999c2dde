// PointSequence holds points that move along samples, as from the point cache of an animation.
#pragma once

#include <cstddef>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// Linear between samples, constant before the first and after the last.
struct MUSLIN_API PointSequence {
  std::size_t points = 0;
  std::vector<double> times;               ///< of the samples [s], strictly ascending, at least one
  std::vector<Eigen::Vector3f> positions;  ///< #samples by #points, sample after sample [m]

  Vec3 at(double time, std::size_t point) const;
};

}  // namespace muslin
