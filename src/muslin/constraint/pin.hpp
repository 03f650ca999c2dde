// A Pin holds vertices in place or moves them along keyframes for some time.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/point_sequence.hpp"

namespace muslin {

/// A rigid motion given by keyframes: linear in translation, spherical-linear in rotation between them,
/// constant before the first and after the last. No keyframes: the identity.
struct MUSLIN_API Motion {
  struct Key {
    double time = 0;                ///< [s]
    Vec3 translate = Vec3::Zero();  ///< [m]
    Eigen::Quaterniond rotate = Eigen::Quaterniond::Identity();
  };
  std::vector<Key> keys;      ///< times ascend strictly
  Vec3 pivot = Vec3::Zero();  ///< rotations turn about this point [m]

  Eigen::Isometry3d at(double time) const;
};

/// Holds `vertices` from `from` until `until`: vertex v is at motion(t)·motion(from)⁻¹ applied to its
/// position when the pin began. With a sequence, v instead keeps the offset that it had at that time from the
/// point it follows.
struct Pin {
  std::string name;
  std::vector<int> vertices;                               ///< global vertex indices, ascending
  double from = 0;                                         ///< [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
  Motion motion;
  std::shared_ptr<const PointSequence> sequence = nullptr;  ///< null: `motion` applies
  std::vector<int> points = {};  ///< #vertices: the point of the sequence that each follows

  bool active(double time) const { return time >= from && time < until; }
};

}  // namespace muslin
