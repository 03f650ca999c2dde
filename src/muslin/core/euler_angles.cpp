#include "muslin/core/euler_angles.hpp"

#include <cmath>
#include <numbers>

namespace muslin {
namespace {

Mat3 turn(double degrees, const Vec3& axis) {
  const double reduced = std::remainder(degrees, 360.0);
  Mat3 result = Eigen::AngleAxisd(reduced * std::numbers::pi / 180.0, axis).toRotationMatrix();
  if (std::fmod(reduced, 90.0) == 0) result = result.array().round().matrix();
  return result;
}

}  // namespace

Mat3 turned_by_degrees(const Vec3& degrees) {
  return turn(degrees.z(), Vec3::UnitZ()) * turn(degrees.y(), Vec3::UnitY()) *
         turn(degrees.x(), Vec3::UnitX());
}

}  // namespace muslin
