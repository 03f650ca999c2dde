// The patterns of fields that are one formula.
#pragma once

#include "muslin/force/field.hpp"

namespace muslin {

/// One vector, which does not depend on the place. The falloff counts from the centre.
class UniformPattern : public FieldPattern {
 public:
  explicit UniformPattern(const Vec3& direction) : direction_(direction) {}
  FieldSample at(const Vec3& place, double) const override { return {direction_, place.norm()}; }

 private:
  Vec3 direction_;
};

/// The vector of length 1 that points away from the centre, in which it is zero.
class RadialPattern : public FieldPattern {
 public:
  FieldSample at(const Vec3& place, double) const override {
    const double distance = place.norm();
    return {distance > 0 ? Vec3(place / distance) : Vec3(Vec3::Zero()), distance};
  }
};

/// Rotation about an axis through the centre, counterclockwise seen against the axis, with length 1 at
/// `radius`. The falloff counts from the axis. With the falloff { power = 2, min = radius } it is Rankine's
/// vortex: solid rotation within the radius, irrotational outside, where its circulation is 2π radius
/// strength. Source: W. J. M. Rankine, A Manual of Applied Mechanics, 1858, §633.
class VortexPattern : public FieldPattern {
 public:
  /// axis: of length 1; radius > 0 [m].
  VortexPattern(const Vec3& axis, double radius) : axis_(axis), radius_(radius) {}
  FieldSample at(const Vec3& place, double) const override {
    const Vec3 around = axis_.cross(place);
    return {around / radius_, around.norm()};
  }

 private:
  Vec3 axis_;
  double radius_;
};

}  // namespace muslin
