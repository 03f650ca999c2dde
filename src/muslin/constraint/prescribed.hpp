// Prescribed vertices follow a function of time: they belong to colliders that are static, move along
// keyframes, or follow the samples of an animation.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/constraint/pin.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/point_sequence.hpp"

namespace muslin {

/// Vertices first … first + start.size() − 1 are at motion(t)·motion(0)⁻¹ applied to their start positions,
/// or, with a sequence, at `placement` applied to its points.
struct MUSLIN_API Prescribed {
  int first = 0;
  std::vector<Vec3> start;  ///< at time 0 [m]
  Motion motion;
  std::shared_ptr<const PointSequence> sequence;  ///< with #start points; null: `motion` applies
  Eigen::Affine3d placement = Eigen::Affine3d::Identity();

  /// Computes the positions x of these vertices, #start by 3 [m].
  void positions(double time, Vectors x) const;
  bool moves() const { return !motion.keys.empty() || sequence != nullptr; }
  /// Sets fixed[v] = 1 and the targets of these vertices at the end of a step; both over all vertices.
  void hold(double time_end, std::span<std::uint8_t> fixed, Vectors targets) const;
};

}  // namespace muslin
