// CurvePattern guides along a polyline.
#pragma once

#include <vector>

#include "muslin/force/field.hpp"

namespace muslin {

/// The vector is t + attraction · min(d / radius, 1) · e: t is the direction of the curve at its nearest
/// point, blended along each segment between those of its ends; d the distance to that point, e the direction
/// to it. The falloff counts d.
class CurvePattern : public FieldPattern {
 public:
  struct Settings {
    std::vector<Vec3> points;  ///< at least two, neighbours differ [m]
    double attraction = 0;     ///< of a strength of 1
    double radius = 0.1;       ///< [m] > 0
  };
  explicit CurvePattern(Settings settings);
  FieldSample at(const Vec3& place, double time) const override;

 private:
  Settings settings_;
  std::vector<Vec3> tangents_;  ///< one per point, of length 1
};

}  // namespace muslin
