#include "muslin/constraint/pin.hpp"

#include <algorithm>

namespace muslin {

Eigen::Isometry3d Motion::at(double time) const {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  if (keys.empty()) return result;

  const auto next =
      std::upper_bound(keys.begin(), keys.end(), time, [](double t, const Key& key) { return t < key.time; });
  Vec3 translate;
  Eigen::Quaterniond rotate;
  if (next == keys.begin() || next == keys.end()) {
    const Key& key = next == keys.begin() ? keys.front() : keys.back();
    translate = key.translate;
    rotate = key.rotate;
  } else {
    const Key& a = *(next - 1);
    const Key& b = *next;
    const double share = (time - a.time) / (b.time - a.time);
    translate = a.translate + share * (b.translate - a.translate);
    rotate = a.rotate.normalized().slerp(share, b.rotate.normalized());
  }
  result.linear() = rotate.normalized().toRotationMatrix();
  result.translation() = translate + pivot - result.linear() * pivot;
  return result;
}

}  // namespace muslin
