#include "muslin/solver/rigid_correction.hpp"

#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace muslin {
namespace {

constexpr double no_weight = 1e-9;  // of what a contact moves along with a group
constexpr int turns = 3;            // Newton iterations for the rotation

/// Parts that move together, found by joining pairs.
class Groups {
 public:
  explicit Groups(std::size_t parts) : above_(parts) { std::iota(above_.begin(), above_.end(), std::size_t{0}); }
  std::size_t of(std::size_t part) {
    while (above_[part] != part) part = above_[part] = above_[above_[part]];
    return part;
  }
  void join(std::size_t a, std::size_t b) {
    a = of(a), b = of(b);
    above_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> above_;
};

struct Group {
  double mass = 0;
  bool held = false, outside = false;  ///< has held vertices; touches what is not of it
  Mat3 stiffness = Mat3::Zero();       ///< of its contacts with what is outside
  Vec3 force = Vec3::Zero(), centre = Vec3::Zero(), torque = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  Vec3 shift = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
};

Mat3 rotation_of(const Vec3& angle) {
  const double length = angle.norm();
  return length > 0 ? Eigen::AngleAxisd(length, angle / length).toRotationMatrix() : Mat3::Identity();
}

}  // namespace

void correct_rigid_motions(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                           ConstVectors g, Vectors x) {
  const std::size_t count = x.size();
  const auto part_of = [&](std::size_t v) {
    return problem.parts.empty() ? std::size_t{0} : static_cast<std::size_t>(problem.parts[v]);
  };
  std::size_t parts = 1;
  for (std::size_t v = 0; v < count; ++v) parts = std::max(parts, part_of(v) + 1);
  Groups groups(parts);
  std::vector<Group> all(parts);
  if (guard) {
    guard->for_each_contact([&](const StepGuard::Contact& contact) {
      std::size_t first = parts;
      for (const StepGuard::Weight& w : contact.weights) {
        if (function.held(static_cast<std::size_t>(w.vertex))) continue;
        const std::size_t part = part_of(static_cast<std::size_t>(w.vertex));
        if (first < parts) groups.join(first, part);
        first = part;
      }
    });
    const double scale = function.dt() * function.dt();
    guard->for_each_contact([&](const StepGuard::Contact& contact) {
      double weight = 0;
      std::size_t part = parts;
      for (const StepGuard::Weight& w : contact.weights) {
        if (function.held(static_cast<std::size_t>(w.vertex))) continue;
        weight += w.weight;
        part = part_of(static_cast<std::size_t>(w.vertex));
      }
      if (part == parts || std::abs(weight) < no_weight) return;
      Group& group = all[groups.of(part)];
      group.outside = true;
      const Mat3 along = contact.normal * contact.normal.transpose();
      group.stiffness += scale * weight * weight *
                         (contact.normal_stiffness * along + contact.tangential * (Mat3::Identity() - along));
    });
  }
  for (std::size_t v = 0; v < count; ++v) {
    Group& group = all[groups.of(part_of(v))];
    if (function.held(v)) {
      group.held = true;
      continue;
    }
    const double m = problem.masses[v];
    group.mass += m;
    group.force += g[v];
    group.centre += m * x[v];
  }
  bool any = false;
  for (Group& group : all) {
    if (group.held || !(group.mass > 0)) continue;
    group.centre /= group.mass;
    const Mat3 resistance = group.mass * Mat3::Identity() + group.stiffness;
    group.shift = -(resistance.ldlt().solve(group.force));
    any = true;
  }
  if (!any) return;
  const auto moves = [&](std::size_t v) -> Group* {
    Group& group = all[groups.of(part_of(v))];
    return group.held || !(group.mass > 0) ? nullptr : &group;
  };
  // The torque of everything but inertia stays what it is while the group turns as a whole.
  for (std::size_t v = 0; v < count; ++v) {
    Group* const group = moves(v);
    if (!group || group->outside) continue;
    const Vec3 r = x[v] - group->centre;
    const double m = problem.masses[v];
    group->torque += r.cross(g[v] - m * (x[v] - function.prediction()[v]));
    group->inertia += m * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  for (int turn = 0; turn < turns; ++turn) {
    std::vector<Vec3> torque(parts, Vec3::Zero());
    for (std::size_t v = 0; v < count; ++v) {
      Group* const group = moves(v);
      if (!group || group->outside) continue;
      const Vec3 r = group->rotation * (x[v] - group->centre);
      const Vec3 there = group->centre + group->shift + r;
      torque[groups.of(part_of(v))] += problem.masses[v] * r.cross(there - function.prediction()[v]);
    }
    for (std::size_t p = 0; p < parts; ++p) {
      Group& group = all[p];
      if (group.held || group.outside || !(group.mass > 0)) continue;
      const double least = 1e-12 * group.inertia.trace();
      if (!(least > 0)) continue;
      const Vec3 angle = -((group.inertia + least * Mat3::Identity()).ldlt().solve(torque[p] + group.torque));
      if (angle.allFinite() && angle.norm() < 0.1) group.rotation = rotation_of(angle) * group.rotation;
    }
  }
  std::vector<Vec3> d(count, Vec3::Zero());
  double farthest = 0;
  for (std::size_t v = 0; v < count; ++v) {
    const Group* const group = moves(v);
    if (!group) continue;
    const Vec3 r = x[v] - group->centre;
    d[v] = group->shift + (group->rotation * r - r);
    if (!d[v].allFinite()) return;
    farthest = std::max(farthest, d[v].norm());
  }
  if (guard && farthest > guard->slack()) guard->limit(x, d);
  for (std::size_t v = 0; v < count; ++v) x[v] += d[v];
}

}  // namespace muslin
