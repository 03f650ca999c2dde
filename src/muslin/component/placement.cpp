#include "muslin/component/placement.hpp"

#include "muslin/core/euler_angles.hpp"

namespace muslin {

Eigen::Quaterniond rotation_from_degrees(const Vec3& degrees) {
  return Eigen::Quaterniond(turned_by_degrees(degrees)).normalized();
}

Eigen::Affine3d placement(const Vec3& translate, const Vec3& rotate_degrees, const Vec3& scale) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() = turned_by_degrees(rotate_degrees) * scale.asDiagonal();
  result.translation() = translate;
  return result;
}

}  // namespace muslin
