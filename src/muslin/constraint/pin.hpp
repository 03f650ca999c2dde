// A Pin holds vertices in place or moves them along keyframes for some time, exactly or by springs.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/constraint/acting.hpp"
#include "muslin/core/keyed_number.hpp"
#include "muslin/core/keyframes.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/point_sequence.hpp"

namespace muslin {

/// A motion given by keyframes: between them translation and scale go along a line and the rotation along an
/// arc, at a rate that the interpolation sets. From half a turn about an axis on, the angles themselves go
/// along a line, so that 360° are a full turn. Constant before the first and after the last. No keyframes:
/// the identity.
struct MUSLIN_API Motion {
  struct Key {
    double time = 0;                ///< [s]
    Vec3 translate = Vec3::Zero();  ///< [m]
    Eigen::Quaterniond rotate = Eigen::Quaterniond::Identity();
    Vec3 scale = Vec3::Ones();  ///< along the axes before the rotation, > 0; of pins only
    Interpolation interpolation = Interpolation::linear;  ///< to the next key
    Vec3 angles = Vec3::Zero();  ///< of `rotate`, about x, then y, then z, as written [degrees]
  };
  std::vector<Key> keys;      ///< times ascend strictly
  Vec3 pivot = Vec3::Zero();  ///< rotation and scale leave this point where it is [m]

  bool scales() const;
  bool turns() const;
  /// Returns the motion without its scale.
  Eigen::Isometry3d at(double time) const;
  Vec3 scale_at(double time) const;
  /// Returns the map from modelled places to places at `time`, scale included.
  Eigen::Affine3d from_model(double time) const;
  /// Returns the map from places at time `begin` to places at `time`, scale included.
  Eigen::Affine3d between(double begin, double time) const;
};

/// Holds `vertices` from `from` until `until`. The target of vertex v is motion(t) applied to its position at
/// the start. If the pin begins later, it takes v where it is: the target is motion(t)·motion(from)⁻¹ applied
/// to its position then. With a sequence, v instead keeps the offset that it had when the pin began from the
/// point it follows. Vertices of a hard pin are at their targets, those of a soft one are pulled there.
struct Pin {
  std::string name;
  std::vector<int> vertices;                               ///< global vertex indices, ascending
  double from = 0;                                         ///< [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
  Motion motion;
  std::shared_ptr<const PointSequence> sequence = nullptr;  ///< null: `motion` applies
  std::vector<int> points = {};  ///< #vertices: the point of the sequence that each follows
  std::vector<double> stiffness = {};  ///< #vertices, of the springs of a soft pin [N/m]; empty: a hard pin
  std::vector<double> damping = {};    ///< #vertices, against the motion of the target [N·s/m]; or empty
  KeyedNumber weight = 1;              ///< of a soft pin over time: a factor of both

  bool begins_late() const { return from > 0; }
  bool is_soft() const { return !stiffness.empty(); }
  /// True if it acts in the step from time_begin to time_end.
  bool acts(double time_begin, double time_end) const { return acting(from, until, time_begin, time_end); }
};

}  // namespace muslin
