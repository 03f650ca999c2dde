#include "muslin/constraint/pin.hpp"

#include <algorithm>

namespace muslin {
namespace {

/// The keyframes around a time, and how far it is from the first to the second one, 0 to 1.
struct Around {
  const Motion::Key &first, &second;
  double share;
};

Around around(const std::vector<Motion::Key>& keys, double time) {
  const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                     [](double t, const Motion::Key& key) { return t < key.time; });
  if (next == keys.begin()) return {keys.front(), keys.front(), 0};
  if (next == keys.end()) return {keys.back(), keys.back(), 0};
  const Motion::Key &a = *(next - 1), &b = *next;
  return {a, b, (time - a.time) / (b.time - a.time)};
}

}  // namespace

bool Motion::scales() const {
  return std::any_of(keys.begin(), keys.end(), [](const Key& key) { return key.scale != Vec3::Ones(); });
}

Eigen::Isometry3d Motion::at(double time) const {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  if (keys.empty()) return result;
  const auto [a, b, share] = around(keys, time);
  Vec3 translate = a.translate;
  Eigen::Quaterniond rotate = a.rotate;
  if (&a != &b) {
    translate = a.translate + share * (b.translate - a.translate);
    rotate = a.rotate.normalized().slerp(share, b.rotate.normalized());
  }
  result.linear() = rotate.normalized().toRotationMatrix();
  result.translation() = translate + pivot - result.linear() * pivot;
  return result;
}

Vec3 Motion::scale_at(double time) const {
  if (keys.empty()) return Vec3::Ones();
  const auto [a, b, share] = around(keys, time);
  return a.scale + share * (b.scale - a.scale);
}

Eigen::Affine3d Motion::between(double begin, double time) const {
  if (keys.empty()) return Eigen::Affine3d::Identity();
  const Eigen::Isometry3d there = at(time), back = at(begin).inverse();
  const Vec3 growth = scale_at(time).cwiseQuotient(scale_at(begin));
  if (growth == Vec3::Ones()) return Eigen::Affine3d(there * back);
  return there * (Eigen::Translation3d(pivot) * Eigen::Scaling(growth) * Eigen::Translation3d(-pivot)) * back;
}

}  // namespace muslin
