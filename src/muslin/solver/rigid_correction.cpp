#include "muslin/solver/rigid_correction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "muslin/core/parallel.hpp"
#include "muslin/solver/part_sums.hpp"
#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

constexpr double no_weight = 1e-9;  // net weight of a contact on its group
constexpr int turns = 3;            // Newton iterations for the rotation
/// Work is corrected by at most this share of the motion: if more is needed, as for bodies at rest, the
/// motion consists of solver errors. No correction where the energy is hardly convex.
constexpr double max_share = 0.05, least_curvature = 0.1;
/// A group is at rest if it moves by less than this share of the displacement by loads.
constexpr double resting = 0.1;

/// Parts that move together since they touch.
class Groups {
 public:
  Groups(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard)
      : problem_(problem) {
    int parts = 0;
    for (const int part : problem.parts) parts = std::max(parts, part);
    of_part_.resize(static_cast<std::size_t>(parts) + 1);
    std::iota(of_part_.begin(), of_part_.end(), std::size_t{0});
    if (!guard) return;
    guard->for_each_contact([&](const StepGuard::Contact& contact) {
      std::size_t first = size();
      for (const StepGuard::Weight& w : contact.weights) {
        const auto v = static_cast<std::size_t>(w.vertex);
        if (function.held(v)) continue;
        if (first < size()) join(first, part_of(v));
        first = part_of(v);
      }
    });
    for (std::size_t part = 0; part < size(); ++part) of_part_[part] = root(part);
  }
  std::size_t size() const { return of_part_.size(); }
  std::size_t of_vertex(std::size_t v) const { return of_part_[part_of(v)]; }

 private:
  std::size_t part_of(std::size_t v) const {
    return problem_.parts.empty() ? std::size_t{0} : static_cast<std::size_t>(problem_.parts[v]);
  }
  std::size_t root(std::size_t part) {
    while (of_part_[part] != part) part = of_part_[part] = of_part_[of_part_[part]];
    return part;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a), b = root(b);
    of_part_[std::max(a, b)] = std::min(a, b);
  }

  const StepProblem& problem_;
  std::vector<std::size_t> of_part_;
};

/// Calls visit(group, stiffness) for each contact of a group with its outside, with the stiffness against
/// translations of the group times dt² [kg].
template <class Visit>
void for_each_outer_contact(const IncrementalPotential& function, StepGuard* guard, const Groups& groups,
                            const Visit& visit) {
  if (!guard) return;
  const double scale = function.dt() * function.dt();
  guard->for_each_contact([&](const StepGuard::Contact& contact) {
    double weight = 0;
    std::size_t group = groups.size();
    for (const StepGuard::Weight& w : contact.weights) {
      if (function.held(static_cast<std::size_t>(w.vertex))) continue;
      weight += w.weight;
      group = groups.of_vertex(static_cast<std::size_t>(w.vertex));
    }
    if (group == groups.size() || std::abs(weight) < no_weight) return;
    const Mat3 along = contact.normal * contact.normal.transpose();
    visit(group, Mat3(scale * weight * weight *
                      (contact.normal_stiffness * along + contact.tangential * (Mat3::Identity() - along))));
  });
}

struct Group {
  double mass = 0;
  bool held = false, outside = false;  ///< has held vertices; touches something outside
  Mat3 stiffness = Mat3::Zero();       ///< of its contacts with the outside
  Vec3 centre = Vec3::Zero(), shift = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();

  bool moves() const { return !held && mass > 0; }
  bool turns() const { return moves() && !outside; }
};

/// Inertia and angular momentum (or torque) of a group.
struct Turning {
  Vec3 momentum = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  void add(double mass, const Vec3& r, const Vec3& moment) {
    momentum += moment;
    inertia += mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  void operator+=(const Turning& other) { momentum += other.momentum, inertia += other.inertia; }
};

/// The motion of a group in a step, and the work that the residual has done on it.
struct MovingGroup {
  double mass = 0;
  bool held = false, outside = false;  ///< has held vertices; touches something outside
  Vec3 centre = Vec3::Zero(), shift = Vec3::Zero(), turn = Vec3::Zero();
  Mat3 stiffness = Mat3::Zero();
  double work = 0, curvature = 0, inertial = 0;
  double falls = 0;  ///< its displacement by loads alone in a step [m]

  /// Returns the share of its motion to add.
  double share() const {
    if (!(curvature >= least_curvature * inertial) || curvature == 0) return 0;
    if (inertial < mass * resting * resting * falls * falls) return 0;
    const double share = -work / curvature;
    return std::abs(share) <= max_share ? share : 0;
  }
};

Mat3 rotation_of(const Vec3& angle) {
  const double length = angle.norm();
  return length > 0 ? Eigen::AngleAxisd(length, angle / length).toRotationMatrix() : Mat3::Identity();
}

/// Calls f(v) once for each v < count, on any thread, and returns the largest value; infinite or not a number
/// if one of them is.
template <class F>
double largest(std::size_t count, const F& f) {
  struct Largest {
    double value = 0;
    Largest operator+(const Largest& other) const {
      return {value < other.value || std::isnan(other.value) ? other.value : value};
    }
  };
  return parallel_sum(count, 2048, Largest{},
                      [&](std::size_t begin, std::size_t end) {
                        Largest sum;
                        for (std::size_t v = begin; v < end; ++v) sum = sum + Largest{f(v)};
                        return sum;
                      })
      .value;
}

}  // namespace

void correct_rigid_motions(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                           ConstVectors g, Vectors x) {
  const std::size_t count = x.size();
  const Groups groups(problem, function, guard);
  const auto group_of = [&](std::size_t v) { return groups.of_vertex(v); };
  struct Sums {
    bool held = false;
    double mass = 0;
    Vec3 force = Vec3::Zero(), centre = Vec3::Zero();
    void operator+=(const Sums& other) {
      held |= other.held, mass += other.mass, force += other.force, centre += other.centre;
    }
  };
  const auto sums = sum_by_part<Sums>(count, groups.size(), group_of, [&](Sums& sum, std::size_t v) {
    if (function.held(v)) {
      sum.held = true;
      return;
    }
    const double m = problem.masses[v];
    sum.mass += m;
    sum.force += g[v];
    sum.centre += m * x[v];
  });
  std::vector<Group> all(groups.size());
  for_each_outer_contact(function, guard, groups, [&](std::size_t touching, const Mat3& stiffness) {
    all[touching].outside = true;
    all[touching].stiffness += stiffness;
  });
  bool any = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Group& group = all[i];
    group.held = sums[i].held;
    group.mass = sums[i].mass;
    if (!group.moves()) continue;
    group.centre = sums[i].centre / group.mass;
    const Mat3 resistance = group.mass * Mat3::Identity() + group.stiffness;
    group.shift = -(resistance.ldlt().solve(sums[i].force));
    any = true;
  }
  if (!any) return;
  // The torque of all forces but inertia is constant while the group rotates as a whole.
  const auto turning = sum_by_part<Turning>(count, groups.size(), group_of, [&](Turning& sum, std::size_t v) {
    const Group& group = all[group_of(v)];
    if (!group.turns()) return;
    const Vec3 r = x[v] - group.centre;
    const double m = problem.masses[v];
    sum.add(m, r, r.cross(g[v] - m * (x[v] - function.prediction()[v])));
  });
  struct Torque {
    Vec3 of = Vec3::Zero();
    void operator+=(const Torque& other) { of += other.of; }
  };
  for (int turn = 0; turn < turns; ++turn) {
    const auto torque = sum_by_part<Torque>(count, groups.size(), group_of, [&](Torque& sum, std::size_t v) {
      const Group& group = all[group_of(v)];
      if (!group.turns()) return;
      const Vec3 r = group.rotation * (x[v] - group.centre);
      const Vec3 there = group.centre + group.shift + r;
      sum.of += problem.masses[v] * r.cross(there - function.prediction()[v]);
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      Group& group = all[i];
      const Mat3& inertia = turning[i].inertia;
      const double least = 1e-12 * inertia.trace();
      if (!group.turns() || !(least > 0)) continue;
      const Vec3 angle =
          -((inertia + least * Mat3::Identity()).ldlt().solve(torque[i].of + turning[i].momentum));
      if (angle.allFinite() && angle.norm() < 0.1) group.rotation = rotation_of(angle) * group.rotation;
    }
  }
  std::vector<Vec3> d(count, Vec3::Zero());
  std::vector<int> moved_group(count, -1);
  const double farthest = largest(count, [&](std::size_t v) {
    const Group& group = all[group_of(v)];
    if (!group.moves()) return 0.0;
    const Vec3 r = x[v] - group.centre;
    d[v] = group.shift + (group.rotation * r - r);
    moved_group[v] = static_cast<int>(group_of(v));
    return d[v].norm();
  });
  if (!std::isfinite(farthest)) return;
  if (guard && farthest > guard->slack()) guard->limit(x, d, moved_group);
  for_each_vertex(count, [&](std::size_t v) { x[v] += d[v]; });
}

void correct_work(const StepProblem& problem, const IncrementalPotential& function, StepGuard* guard,
                  ConstVectors from, Vectors g, Vectors x) {
  const std::size_t count = x.size();
  const Groups groups(problem, function, guard);
  const auto group_of = [&](std::size_t v) { return groups.of_vertex(v); };
  struct Sums {
    bool held = false;
    double mass = 0, falls = 0;
    Vec3 centre = Vec3::Zero(), shift = Vec3::Zero();
    void operator+=(const Sums& other) {
      held |= other.held, mass += other.mass, falls = std::max(falls, other.falls);
      centre += other.centre, shift += other.shift;
    }
  };
  const auto sums = sum_by_part<Sums>(count, groups.size(), group_of, [&](Sums& sum, std::size_t v) {
    if (function.held(v)) {
      sum.held = true;
      return;
    }
    const double m = problem.masses[v];
    const std::size_t part = problem.parts.empty() ? 0 : static_cast<std::size_t>(problem.parts[v]);
    if (part < problem.accelerations.size())
      sum.falls = std::max(sum.falls, problem.accelerations[part] * function.dt() * function.dt());
    sum.mass += m;
    sum.centre += m * x[v];
    sum.shift += m * (x[v] - from[v]);
  });
  std::vector<MovingGroup> all(groups.size());
  for_each_outer_contact(function, guard, groups, [&](std::size_t touching, const Mat3& stiffness) {
    all[touching].outside = true;
    all[touching].stiffness += stiffness;
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    MovingGroup& group = all[i];
    group.held = sums[i].held, group.mass = sums[i].mass, group.falls = sums[i].falls;
    if (group.mass > 0) group.centre = sums[i].centre / group.mass, group.shift = sums[i].shift / group.mass;
    // A group is free along the surfaces it touches, but not against them.
    if (group.outside)
      group.shift = (Mat3::Identity() + group.stiffness / group.mass).ldlt().solve(group.shift).eval();
    if (group.held) group.shift.setZero();
  }
  const auto turning = sum_by_part<Turning>(count, groups.size(), group_of, [&](Turning& sum, std::size_t v) {
    const MovingGroup& group = all[group_of(v)];
    if (function.held(v) || group.held || group.outside) return;
    const Vec3 r = x[v] - group.centre;
    const double m = problem.masses[v];
    sum.add(m, r, m * r.cross(x[v] - from[v]));
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Mat3& inertia = turning[i].inertia;
    const double least = 1e-12 * inertia.trace();
    all[i].turn = least > 0 ? Vec3((inertia + least * Mat3::Identity()).ldlt().solve(turning[i].momentum))
                            : Vec3(Vec3::Zero());
  }
  std::vector<Vec3> s(count, Vec3::Zero()), hs(count);
  for_each_vertex(count, [&](std::size_t v) {
    if (function.held(v)) return;
    const MovingGroup& group = all[group_of(v)];
    s[v] = x[v] - from[v];
    s[v] -= group.shift + group.turn.cross(x[v] - group.centre);
  });
  function.hessian_product(x, s, hs);
  struct Works {
    double work = 0, curvature = 0, inertial = 0;
    void operator+=(const Works& other) {
      work += other.work, curvature += other.curvature, inertial += other.inertial;
    }
  };
  const auto works = sum_by_part<Works>(count, groups.size(), group_of, [&](Works& sum, std::size_t v) {
    if (function.held(v)) return;
    sum.work += g[v].dot(s[v]);
    sum.curvature += hs[v].dot(s[v]);
    sum.inertial += problem.masses[v] * s[v].squaredNorm();
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].work = works[i].work, all[i].curvature = works[i].curvature, all[i].inertial = works[i].inertial;
  }
  const double farthest = largest(count, [&](std::size_t v) {
    const double share = function.held(v) ? 0.0 : all[group_of(v)].share();
    s[v] *= share;
    hs[v] *= share;
    return hs[v].allFinite() ? s[v].norm() : std::numeric_limits<double>::infinity();
  });
  if (farthest == 0 || !std::isfinite(farthest) || !(function.max_step(x, s) > 1)) return;
  if (guard && farthest > guard->slack()) {
    // A partly limited motion would change momenta.
    std::vector<Vec3> limited = s;
    guard->limit(x, limited);
    if (limited != s) return;
  }
  for_each_vertex(count, [&](std::size_t v) {
    x[v] += s[v];
    g[v] += hs[v];
  });
}

}  // namespace muslin
