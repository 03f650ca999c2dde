#include "muslin/solver/rigid_prediction.hpp"

#include <array>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace muslin {
namespace {

using Four = std::array<Vec3, 4>;

Four four(ConstVectors all, std::size_t first) {
  return {all[first], all[first + 1], all[first + 2], all[first + 3]};
}
Vec3 mean(const Four& x) { return (x[0] + x[1] + x[2] + x[3]) / 4; }

Mat3 turn(const Vec3& angle) {
  const double length = angle.norm();
  return length > 0 ? Eigen::AngleAxisd(length, angle / length).toRotationMatrix() : Mat3::Identity();
}

/// Rotates `arms` freely by their spin and computes the velocities from their final spin.
void turn_freely(const Four& arms, const Four& relative_velocities, double dt, Four& turned,
                 Four& velocities) {
  Vec3 momentum = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    momentum += arms[i].cross(relative_velocities[i]);
    inertia += arms[i].squaredNorm() * Mat3::Identity() - arms[i] * arms[i].transpose();
  }
  const auto spin = [&](const Mat3& r) { return Vec3(r * (inertia.inverse() * (r.transpose() * momentum))); };
  const Mat3 half = turn(dt / 2 * spin(Mat3::Identity()));
  const Mat3 whole = turn(dt * spin(half));
  const Vec3 after = spin(whole);
  for (std::size_t i = 0; i < 4; ++i) {
    turned[i] = whole * arms[i];
    velocities[i] = after.cross(turned[i]);
  }
}

/// Returns the rotation that brings `from` nearest to `to`.
Mat3 nearest_rotation(const Four& from, const Four& to) {
  Mat3 product = Mat3::Zero();
  for (std::size_t i = 0; i < 4; ++i) product += to[i] * from[i].transpose();
  const Eigen::JacobiSVD<Mat3> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
  return u * svd.matrixV().transpose();
}

}  // namespace

void predict_rigid(Integrator integrator, const State& state, std::size_t first, StepContext& context) {
  if (integrator == Integrator::symplectic_euler) return;
  Four arms = four(state.positions, first), arms_velocities = four(state.velocities, first);
  const Vec3 centre = mean(arms), velocity = mean(arms_velocities);
  for (Vec3& arm : arms) arm -= centre;
  for (Vec3& v : arms_velocities) v -= velocity;

  // BDF2 begins with a step of implicit Euler.
  if (integrator == Integrator::bdf2 && context.dt < context.length) {
    Four predicted = four(context.inertial_prediction, first);
    const Vec3 middle = mean(predicted);
    for (Vec3& x : predicted) x -= middle;
    const Mat3 rotation = nearest_rotation(arms, predicted);
    for (std::size_t i = 0; i < 4; ++i) context.inertial_prediction[first + i] = middle + rotation * arms[i];
    return;
  }
  Four turned, velocities;
  turn_freely(arms, arms_velocities, context.dt, turned, velocities);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 there = centre + context.dt * velocity + turned[i];
    context.inertial_prediction[first + i] = there;
    context.anchor[first + i] = there - context.dt * (velocity + velocities[i]);
  }
  context.rigidly_rotated.resize(context.anchor.size(), 0);
  for (std::size_t i = 0; i < 4; ++i) context.rigidly_rotated[first + i] = 1;
}

}  // namespace muslin
