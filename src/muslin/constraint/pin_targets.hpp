// PinTargets computes the places where a pin wants its vertices at one moment.
//
// The anchor of a vertex is its position when the pin began; with a sequence, relative to its point there.
#pragma once

#include <cstddef>

#include "muslin/constraint/pin.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

class PinTargets {
 public:
  /// `pin` must outlive this.
  PinTargets(const Pin& pin, double time);

  /// Returns the target of vertex i of the pin [m].
  Vec3 at(std::size_t i, const Vec3& anchor) const;
  /// Returns the anchor with which vertex i has its target at `position`.
  Vec3 anchor(std::size_t i, const Vec3& position) const;

  /// Returns the anchor of vertex i, which is at `position`, of a pin that takes hold in a step from `time`.
  /// If it began earlier and its anchors are lost, as by a cut, the target goes on from `position`.
  static Vec3 first_anchor(const Pin& pin, double time, std::size_t i, const Vec3& position);

 private:
  const Pin& pin_;
  double time_;
  bool moves_;
  Eigen::Affine3d motion_;
};

}  // namespace muslin
