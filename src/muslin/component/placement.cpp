#include "muslin/component/placement.hpp"

#include <cmath>
#include <numbers>

namespace muslin {
namespace {

/// Returns exact values for multiples of a quarter turn, so that a body turned upright keeps its round
/// coordinates.
Eigen::Matrix3d turn(double degrees, const Vec3& axis) {
  const double reduced = std::remainder(degrees, 360.0);
  Eigen::Matrix3d result = Eigen::AngleAxisd(reduced * std::numbers::pi / 180.0, axis).toRotationMatrix();
  if (std::fmod(reduced, 90.0) == 0) result = result.array().round().matrix();
  return result;
}

Eigen::Matrix3d turns(const Vec3& degrees) {
  return turn(degrees.z(), Vec3::UnitZ()) * turn(degrees.y(), Vec3::UnitY()) *
         turn(degrees.x(), Vec3::UnitX());
}

}  // namespace

Eigen::Quaterniond rotation_from_degrees(const Vec3& degrees) {
  return Eigen::Quaterniond(turns(degrees)).normalized();
}

Eigen::Affine3d placement(const Vec3& translate, const Vec3& rotate_degrees, const Vec3& scale) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() = turns(rotate_degrees) * scale.asDiagonal();
  result.translation() = translate;
  return result;
}

}  // namespace muslin
