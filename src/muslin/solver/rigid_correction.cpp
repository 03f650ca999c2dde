#include "muslin/solver/rigid_correction.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace muslin {
namespace {

constexpr double no_weight = 1e-9;  // net weight of a contact on its group
constexpr int turns = 3;            // Newton iterations for the rotation
/// Work is corrected by at most this share of the motion: if more is needed, as for bodies at rest, the
/// motion consists of solver errors. No correction where the energy is hardly convex.
constexpr double most_share = 0.05, least_curvature = 0.1;
/// A group is at rest if it moves by less than this share of the displacement by loads.
constexpr double resting = 0.1;

/// Parts that move together, found by joining pairs.
class Groups {
 public:
  explicit Groups(std::size_t parts) : above_(parts) { std::iota(above_.begin(), above_.end(), std::size_t{0}); }
  std::size_t size() const { return above_.size(); }
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

std::size_t part_of(const StepProblem& problem, std::size_t v) {
  return problem.parts.empty() ? std::size_t{0} : static_cast<std::size_t>(problem.parts[v]);
}

/// Groups the parts of the step's vertices; touching parts are joined.
Groups touching_groups(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard) {
  std::size_t parts = 1;
  for (std::size_t v = 0; v < problem.parts.size(); ++v)
    parts = std::max(parts, static_cast<std::size_t>(problem.parts[v]) + 1);
  Groups groups(parts);
  if (!guard) return groups;
  guard->for_each_contact([&](const StepGuard::Contact& contact) {
    std::size_t first = parts;
    for (const StepGuard::Weight& w : contact.weights) {
      if (function.held(static_cast<std::size_t>(w.vertex))) continue;
      const std::size_t part = part_of(problem, static_cast<std::size_t>(w.vertex));
      if (first < parts) groups.join(first, part);
      first = part;
    }
  });
  return groups;
}

/// Calls visit(group, stiffness) for each contact of a group with its outside, with the stiffness against
/// translations of the group times dt² [kg].
template <class Visit>
void for_each_outer_contact(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                            Groups& groups, const Visit& visit) {
  if (!guard) return;
  const double scale = function.dt() * function.dt();
  guard->for_each_contact([&](const StepGuard::Contact& contact) {
    double weight = 0;
    std::size_t part = groups.size();
    for (const StepGuard::Weight& w : contact.weights) {
      if (function.held(static_cast<std::size_t>(w.vertex))) continue;
      weight += w.weight;
      part = part_of(problem, static_cast<std::size_t>(w.vertex));
    }
    if (part == groups.size() || std::abs(weight) < no_weight) return;
    const Mat3 along = contact.normal * contact.normal.transpose();
    visit(groups.of(part), Mat3(scale * weight * weight *
                                (contact.normal_stiffness * along +
                                 contact.tangential * (Mat3::Identity() - along))));
  });
}

struct Group {
  double mass = 0;
  bool held = false, outside = false;  ///< has held vertices; touches something outside
  Mat3 stiffness = Mat3::Zero();       ///< of its contacts with the outside
  Vec3 force = Vec3::Zero(), centre = Vec3::Zero(), torque = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  Vec3 shift = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
};

/// The motion of a group in a step, and the work that the residual has done on it.
struct MovingGroup {
  double mass = 0;
  bool held = false, outside = false;  ///< has held vertices; touches something outside
  Vec3 centre = Vec3::Zero(), shift = Vec3::Zero(), turn = Vec3::Zero();
  Mat3 inertia = Mat3::Zero(), stiffness = Mat3::Zero();
  double work = 0, curvature = 0, inertial = 0;
  double falls = 0;  ///< its displacement by loads alone in a step [m]

  /// Returns the share of its motion to add.
  double share() const {
    if (!(curvature >= least_curvature * inertial) || curvature == 0) return 0;
    if (inertial < mass * resting * resting * falls * falls) return 0;
    const double share = -work / curvature;
    return std::abs(share) <= most_share ? share : 0;
  }
};

Mat3 rotation_of(const Vec3& angle) {
  const double length = angle.norm();
  return length > 0 ? Eigen::AngleAxisd(length, angle / length).toRotationMatrix() : Mat3::Identity();
}

}  // namespace

void correct_rigid_motions(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                           ConstVectors g, Vectors x) {
  const std::size_t count = x.size();
  const auto part_of = [&](std::size_t v) { return muslin::part_of(problem, v); };
  Groups groups = touching_groups(problem, function, guard);
  const std::size_t parts = groups.size();
  std::vector<Group> all(parts);
  for_each_outer_contact(problem, function, guard, groups, [&](std::size_t g, const Mat3& stiffness) {
    all[g].outside = true;
    all[g].stiffness += stiffness;
  });
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
  // The torque of all forces but inertia is constant while the group rotates as a whole.
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
  std::vector<int> group_of(count, -1);
  double farthest = 0;
  for (std::size_t v = 0; v < count; ++v) {
    const Group* const group = moves(v);
    if (!group) continue;
    const Vec3 r = x[v] - group->centre;
    d[v] = group->shift + (group->rotation * r - r);
    group_of[v] = static_cast<int>(groups.of(part_of(v)));
    if (!d[v].allFinite()) return;
    farthest = std::max(farthest, d[v].norm());
  }
  if (guard && farthest > guard->slack()) guard->limit(x, d, group_of);
  for (std::size_t v = 0; v < count; ++v) x[v] += d[v];
}

void correct_work(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                  ConstVectors from, Vectors g, Vectors x) {
  const std::size_t count = x.size();
  Groups groups = touching_groups(problem, function, guard);
  std::vector<MovingGroup> all(groups.size());
  for_each_outer_contact(problem, function, guard, groups, [&](std::size_t touching, const Mat3& stiffness) {
    all[touching].outside = true;
    all[touching].stiffness += stiffness;
  });
  const auto group_of = [&](std::size_t v) { return groups.of(part_of(problem, v)); };
  for (std::size_t v = 0; v < count; ++v) {
    MovingGroup& group = all[group_of(v)];
    if (function.held(v)) {
      group.held = true;
      continue;
    }
    const double m = problem.masses[v];
    const std::size_t part = part_of(problem, v);
    if (part < problem.accelerations.size())
      group.falls = std::max(group.falls, problem.accelerations[part] * function.dt() * function.dt());
    group.mass += m;
    group.centre += m * x[v];
    group.shift += m * (x[v] - from[v]);
  }
  for (MovingGroup& group : all) {
    if (group.mass > 0) group.centre /= group.mass, group.shift /= group.mass;
    // A group is free along the surfaces it touches, but not against them.
    if (group.outside)
      group.shift = (Mat3::Identity() + group.stiffness / group.mass).ldlt().solve(group.shift).eval();
    if (group.held) group.shift.setZero();
  }
  for (std::size_t v = 0; v < count; ++v) {
    MovingGroup& group = all[group_of(v)];
    if (function.held(v) || group.held || group.outside) continue;
    const Vec3 r = x[v] - group.centre;
    const double m = problem.masses[v];
    group.turn += m * r.cross(x[v] - from[v]);
    group.inertia += m * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  for (MovingGroup& group : all) {
    const double least = 1e-12 * group.inertia.trace();
    group.turn = least > 0 ? Vec3((group.inertia + least * Mat3::Identity()).ldlt().solve(group.turn))
                           : Vec3(Vec3::Zero());
  }
  std::vector<Vec3> s(count, Vec3::Zero()), hs(count);
  for (std::size_t v = 0; v < count; ++v) {
    const MovingGroup& group = all[group_of(v)];
    if (function.held(v)) continue;
    s[v] = x[v] - from[v];
    s[v] -= group.shift + group.turn.cross(x[v] - group.centre);
  }
  function.hessian_product(x, s, hs);
  for (std::size_t v = 0; v < count; ++v) {
    if (function.held(v)) continue;
    MovingGroup& group = all[group_of(v)];
    group.work += g[v].dot(s[v]);
    group.curvature += hs[v].dot(s[v]);
    group.inertial += problem.masses[v] * s[v].squaredNorm();
  }
  double farthest = 0;
  for (std::size_t v = 0; v < count; ++v) {
    const MovingGroup& group = all[group_of(v)];
    const double share = function.held(v) ? 0.0 : group.share();
    s[v] *= share;
    hs[v] *= share;
    if (!s[v].allFinite() || !hs[v].allFinite()) return;
    farthest = std::max(farthest, s[v].norm());
  }
  if (farthest == 0 || !(function.max_step(x, s) > 1)) return;
  if (guard && farthest > guard->slack()) {
    // A partly limited motion would change momenta.
    std::vector<Vec3> limited = s;
    guard->limit(x, limited);
    if (limited != s) return;
  }
  for (std::size_t v = 0; v < count; ++v) {
    x[v] += s[v];
    g[v] += hs[v];
  }
}

}  // namespace muslin
