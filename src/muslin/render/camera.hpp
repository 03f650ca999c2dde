// Camera is a static pinhole camera; CameraFit places it so that all points are visible.
#pragma once

#include "muslin/core/vectors.hpp"

namespace muslin {

struct CameraOptions {
  double azimuth = 30;         ///< [deg] from the z axis towards the x axis
  double elevation = 15;       ///< [deg] above the horizon, −89…89
  double field_of_view = 32;   ///< [deg] of the picture's height, 5…120
  double distance_factor = 1;  ///< factor on the distance at which everything just fits
};

struct Camera {
  Vec3 position = Vec3(0, 0, 1);
  Vec3 right = Vec3::UnitX();  ///< unit vectors of the picture
  Vec3 up = Vec3::UnitY();
  Vec3 forward = -Vec3::UnitZ();
  double half_height = 0.3;    ///< tangent of half the field of view
  double half_width = 0.4;     ///< half_height × aspect
  Vec3 target = Vec3::Zero();  ///< middle of the visible objects
  double radius = 1;           ///< [m] of an enclosing ball around target

  /// Returns the pixel (x right, y down) at which a point appears in a picture of this size; the point must
  /// lie in front.
  Vec2 project(const Vec3& point, int width, int height) const;
};

/// Finds one static camera that sees the points of all frames. The position for the given direction is the
/// nearest possible: each of the four sides of the view touches a point. Only four extreme values are stored,
/// not the points.
class CameraFit {
 public:
  /// aspect = width / height. Throws Error(usage) on options outside their ranges.
  CameraFit(const CameraOptions& options, double aspect);
  /// Adds points; those that are not finite are ignored.
  void add(ConstVectors points);
  /// Returns a camera with a margin of 6 % on each side. Without any point, the unit cube is framed.
  Camera camera() const;

 private:
  CameraOptions options_;
  Camera view_;
  Box box_;
  double sides_[4];  // greatest of ±x − z·tan and ±y − z·tan over the points, z along forward
};

}  // namespace muslin
