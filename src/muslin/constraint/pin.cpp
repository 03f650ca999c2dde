#include "muslin/constraint/pin.hpp"

#include <algorithm>

#include "muslin/core/euler_angles.hpp"

namespace muslin {

bool Motion::scales() const {
  return std::any_of(keys.begin(), keys.end(), [](const Key& key) { return key.scale != Vec3::Ones(); });
}

bool Motion::turns() const {
  return std::any_of(keys.begin(), keys.end(), [&](const Key& key) {
    return !key.rotate.isApprox(keys.front().rotate, 1e-12) || key.angles != keys.front().angles;
  });
}

Eigen::Isometry3d Motion::at(double time) const {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  if (keys.empty()) return result;
  const KeyframePair<Key> around = keyframes_around(keys, time);
  Vec3 translate = around.from.translate;
  Eigen::Quaterniond rotate = around.from.rotate;
  if (!around.is_single()) {
    const double share = around.share();
    translate += share * (around.to.translate - around.from.translate);
    const Vec3 turn = around.to.angles - around.from.angles;
    rotate = turn.cwiseAbs().maxCoeff() < 180
                 ? rotate.normalized().slerp(share, around.to.rotate.normalized())
                 : Eigen::Quaterniond(turned_by_degrees(around.from.angles + share * turn));
  }
  result.linear() = rotate.normalized().toRotationMatrix();
  result.translation() = translate + pivot - result.linear() * pivot;
  return result;
}

Vec3 Motion::scale_at(double time) const {
  if (keys.empty()) return Vec3::Ones();
  const KeyframePair<Key> around = keyframes_around(keys, time);
  return around.from.scale + around.share() * (around.to.scale - around.from.scale);
}

Eigen::Affine3d Motion::from_model(double time) const {
  const Vec3 scale = scale_at(time);
  const Eigen::Affine3d there(at(time));
  if (scale == Vec3::Ones()) return there;
  return there * Eigen::Translation3d(pivot) * Eigen::Scaling(scale) * Eigen::Translation3d(-pivot);
}

Eigen::Affine3d Motion::between(double begin, double time) const {
  return from_model(time) * from_model(begin).inverse();
}

}  // namespace muslin
