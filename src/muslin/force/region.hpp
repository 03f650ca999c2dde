// Region bounds a field.
#pragma once

#include <optional>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// The points that lie in all of the given shapes.
struct MUSLIN_API Region {
  struct BoxShape {
    Vec3 min, max;
  };
  struct SphereShape {
    Vec3 center;
    double radius;
  };
  /// Its flat ends are at `from` and `to`, which differ.
  struct CylinderShape {
    Vec3 from, to;
    double radius;
  };
  /// The half space on the side to which the normal points.
  struct PlaneShape {
    Vec3 point, normal;  ///< the normal has length 1
  };
  std::optional<BoxShape> box;
  std::optional<SphereShape> sphere;
  std::optional<CylinderShape> cylinder;
  std::optional<PlaneShape> plane;
  double fade = 0;  ///< [m] ≥ 0

  /// Returns the weight at x: 0 outside, rising smoothly inside to 1 at the depth `fade` below the surface.
  double weight(const Vec3& x) const;
};

}  // namespace muslin
