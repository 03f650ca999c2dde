#include "muslin/contact/step_limiter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "muslin/contact/conservative_advancement.hpp"
#include "muslin/contact/turning_plane.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t limit_grain = 1024;
/// Points with less weight in the closest points do not make a pair approach.
constexpr double least_weight = 0.01;
/// Share of a gap, or of the contact distance if that is less, that deflection leaves, and, near the floor,
/// the number of floors. Smaller shares would let fast surfaces come so close that contact becomes too stiff
/// for few iterations; but kinematic vertices that push others need room to move on.
constexpr double kept_deflected = 0.5, kept_before_pushing = 0.2, kept_floors = 1.5;
/// Deflection leaves this many times the share that every pair must keep.
constexpr double kept_more = 1.1;
/// Most rounds of deflection: vertices against triangles, edges against edges, then both. Each propagates a
/// push by one layer.
constexpr int deflections = 40;
/// Share of its safe displacement that a pair may use, so that it keeps some gap for the next step.
constexpr double given_share = 0.9;
/// Rounds after which shortening is strengthened, and after which it stops vertices, to terminate.
constexpr std::size_t patient_rounds = 8, last_rounds = 24;

/// direction·u ≤ most for the step u of a vertex.
struct HalfSpace {
  int vertex;
  Vec3 direction;
  double most;
};

}  // namespace

struct StepLimiter::Work {
  const SurfaceMap& map;
  const StepLimits& limits;
  std::span<const std::uint8_t> held;
  const ContactCandidates& candidates;
  std::span<const ContactPair> pairs;
  PairDistances& start;             ///< of the pairs at x
  ConstVectors x;                   ///< points
  std::vector<Vec3> u;              ///< their steps
  std::vector<std::uint8_t> moved;  ///< points with changed steps since the last judge()
  std::vector<double> factors;      ///< safe share of the step by pair, 1 for nearly all

  Work(const SurfaceMap& map_, const StepLimits& limits_, std::span<const std::uint8_t> held_,
       PairDistances& start_)
      : map(map_),
        limits(limits_),
        held(held_),
        candidates(start_.candidates()),
        pairs(candidates.pairs()),
        start(start_),
        x(start_.points()),
        u(map_.point_count()),
        moved(map_.point_count(), 1),
        factors(pairs.size(), 1) {}

  bool is_prescribed(int point) const {
    if (held.empty()) return false;
    for (const SurfaceMap::Entry& e : map.row(static_cast<std::size_t>(point)))
      if (held[static_cast<std::size_t>(e.vertex)] == 0) return false;
    return true;
  }

  const Vec3& position(const ContactPair& pair, int i) const {
    return x[static_cast<std::size_t>(pair.points[static_cast<std::size_t>(i)])];
  }
  const Vec3& step(const ContactPair& pair, int i) const {
    return u[static_cast<std::size_t>(pair.points[static_cast<std::size_t>(i)])];
  }

  /// Returns the least distance allowed for a pair that is `distance` apart.
  double required_distance(const ContactPair& pair, double distance) const {
    // A pair closer than the floor, or than its thickness, must not come closer.
    const double gap = distance - pair.thickness;
    const double least = std::max(limits.gap_floor, limits.kept_share * std::min(gap, pair.range));
    return gap > 0 ? pair.thickness + std::min(least, gap * (1 - 1e-6)) : distance * (1 - 1e-6);
  }

  /// Returns the safe share of the step of pair i.
  double safe_factor(std::size_t i) const {
    const ContactPair& pair = pairs[i];
    const auto corners = [&](ConstVectors of) {
      std::array<Vec3, 4> four;
      for (std::size_t k = 0; k < 4; ++k) four[k] = of[static_cast<std::size_t>(pair.points[k])];
      return four;
    };
    if (pair.kind == PairKind::point_plane && pair.point_count() == 4) {
      const double distance = start[i].distance;
      return distance <= 0
                 ? 1
                 : safe_fraction_over_plane(corners(x), corners(u), required_distance(pair, distance));
    }
    if (pair.kind == PairKind::point_plane) {
      const PairGeometry& at = start[i];
      if (at.distance <= 0) return 1;
      const double approach = at.normal.dot(step(pair, 1) - step(pair, 0));
      const double slack = at.distance - required_distance(pair, at.distance);
      return approach <= slack ? 1 : slack / approach;
    }
    // Nearly all pairs move too little to matter.
    const int size_a = first_feature_size(pair.kind);
    double fastest = 0;
    for (int k = 0; k < size_a; ++k)
      for (int j = size_a; j < 4; ++j)
        fastest = std::max(fastest, (step(pair, k) - step(pair, j)).squaredNorm());
    const auto is_far = [&](double distance) {
      const double slack = distance - required_distance(pair, distance);
      return distance > 0 && fastest <= 0.999 * slack * slack;
    };
    if (is_far(start[i].distance)) return 1;
    const PairGeometry& at = start.find(i);
    if (at.distance <= 0 || is_far(at.distance)) return 1;
    const double required = required_distance(pair, at.distance);
    return safe_fraction(pair.kind, corners(x), corners(u), required, limits.gap_floor / 2);
  }

  PairGeometry geometry_at(const ContactPair& pair, const PairGeometry& before_step, double time) const {
    if (pair.point_count() == 2) return before_step;
    std::array<Vec3, 4> p;
    for (int i = 0; i < 4; ++i) p[static_cast<std::size_t>(i)] = position(pair, i) + time * step(pair, i);
    if (pair.kind == PairKind::point_plane) {
      const OverPlane over = over_plane(p);
      return {over.normal, over.distance, over.weights};
    }
    const ClosestPoints c = closest_points(pair.kind, p);
    return {c.difference / c.distance(), c.distance(), c.weights};
  }

  /// Adds half-spaces that keep the points of one side of a pair from moving along `direction` beyond `most`.
  void restrict(const ContactPair& pair, const PairGeometry& at, int begin, int end, const Vec3& direction,
                double most, std::vector<HalfSpace>& out) const {
    for (int i = begin; i < end; ++i) {
      if (std::fabs(at.weights[static_cast<std::size_t>(i)]) < least_weight) continue;
      const int point = pair.points[static_cast<std::size_t>(i)];
      if (direction.dot(u[static_cast<std::size_t>(point)]) <= most) continue;
      const auto row = map.row(static_cast<std::size_t>(point));
      const bool convex =
          map.is_convex() || std::all_of(row.begin(), row.end(), [](const auto& e) { return e.weight >= 0; });
      if (!convex) continue;
      for (const SurfaceMap::Entry& e : row)
        if (e.weight > 0) out.push_back({e.vertex, direction, most});
    }
  }

  /// Adds half-spaces for a pair that comes too close during the step, along its normal at that time.
  void restrict_pair(const ContactPair& pair, const PairGeometry& before_step, double factor,
                     std::vector<HalfSpace>& out) const {
    const PairGeometry at = geometry_at(pair, before_step, factor);
    const int size_a = first_feature_size(pair.kind), count = pair.point_count();
    double approach_a = 0, approach_b = 0, before = 0;
    for (int i = 0; i < count; ++i) {
      const double weight = at.weights[static_cast<std::size_t>(i)];
      (i < size_a ? approach_a : approach_b) -= weight * at.normal.dot(step(pair, i));
      before += weight * at.normal.dot(position(pair, i));
    }
    const bool a_yields = !is_prescribed(pair.points[0]);
    const bool b_yields = !is_prescribed(pair.points[static_cast<std::size_t>(size_a)]);
    const bool pushes = (!a_yields && approach_a > 0) || (!b_yields && approach_b > 0);
    const double gap = before - pair.thickness;
    const double share =
        std::max(pushes ? kept_before_pushing : kept_deflected, kept_more * limits.kept_share);
    const double kept = std::max(kept_floors * limits.gap_floor, share * std::min(gap, pair.range));
    const double slack = std::max(0.0, gap - kept);
    if (approach_a + approach_b <= slack) return;
    // Each side may use the slack in proportion to its approach; a receding side leaves all to the other, and
    // prescribed vertices have priority.
    double max_a = approach_a, max_b = approach_b;
    if (!a_yields || (b_yields && approach_a <= 0)) {
      max_b = slack - approach_a;
    } else if (!b_yields || approach_b <= 0) {
      max_a = slack - approach_b;
    } else {
      max_a = slack * approach_a / (approach_a + approach_b);
      max_b = slack - max_a;
    }
    if (a_yields && max_a < approach_a) restrict(pair, at, 0, size_a, -at.normal, max_a, out);
    if (b_yields && max_b < approach_b) restrict(pair, at, size_a, count, at.normal, max_b, out);
  }

  /// Checks the pairs of points whose step has changed; returns whether any comes too close.
  bool judge(ConstVectors dq) {
    map.apply(dq, u);
    std::vector<std::uint8_t> found((pairs.size() + limit_grain - 1) / limit_grain, 0);
    parallel_for(pairs.size(), limit_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const ContactPair& pair = pairs[i];
        bool look = false;
        for (int k = 0; k < pair.point_count(); ++k)
          look |= moved[static_cast<std::size_t>(pair.points[static_cast<std::size_t>(k)])] != 0;
        if (look) factors[i] = safe_factor(i);
        if (factors[i] < 1) found[begin / limit_grain] = 1;
      }
    });
    std::fill(moved.begin(), moved.end(), 0);
    return std::any_of(found.begin(), found.end(), [](std::uint8_t f) { return f != 0; });
  }

  void mark(std::size_t vertex) {
    for (const SurfaceMap::Entry& e : map.column(vertex)) moved[static_cast<std::size_t>(e.vertex)] = 1;
  }

  /// Removes the excess normal approach of the pairs with chosen(kind) that come too close; marks the changed
  /// vertices in `deflected` (#V).
  template <class Chosen>
  void deflect(Vectors dq, const Chosen& chosen, std::vector<std::uint8_t>& deflected) {
    std::vector<std::vector<HalfSpace>> parts((pairs.size() + limit_grain - 1) / limit_grain);
    parallel_for(pairs.size(), limit_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (factors[i] < 1 && chosen(pairs[i].kind))
          restrict_pair(pairs[i], start[i], factors[i], parts[begin / limit_grain]);
      }
    });
    // By vertex, in the order of the pairs.
    std::vector<int> offsets(dq.size() + 1, 0);
    for (const auto& part : parts)
      for (const HalfSpace& h : part) ++offsets[static_cast<std::size_t>(h.vertex) + 1];
    for (std::size_t v = 0; v < dq.size(); ++v) offsets[v + 1] += offsets[v];
    std::vector<const HalfSpace*> by_vertex(static_cast<std::size_t>(offsets.back()));
    std::vector<int> next(offsets.begin(), offsets.end() - 1);
    for (const auto& part : parts)
      for (const HalfSpace& h : part)
        by_vertex[static_cast<std::size_t>(next[static_cast<std::size_t>(h.vertex)]++)] = &h;
    std::vector<std::uint8_t> changed(dq.size(), 0);
    parallel_for(dq.size(), limit_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (!held.empty() && held[v] != 0) continue;
        for (int i = offsets[v]; i < offsets[v + 1]; ++i) {
          const HalfSpace& h = *by_vertex[static_cast<std::size_t>(i)];
          const double excess = h.direction.dot(dq[v]) - h.most;
          if (excess <= 0) continue;
          dq[v] -= excess * h.direction;
          changed[v] = 1;
        }
      }
    });
    for (std::size_t v = 0; v < dq.size(); ++v) {
      if (changed[v] == 0) continue;
      deflected[v] = 1;
      mark(v);
    }
  }

  /// Returns the largest factor that keeps a point in its box; 1 if the box has moved away from the point.
  double factor_within_box(std::size_t p) const {
    const PointBox& box = candidates.boxes().end(p);
    if (!box.contains(x[p])) return 1;
    double factor = 1;
    for (int k = 0; k < 3; ++k) {
      const double low = box.lower[k] - x[p][k], high = box.upper[k] - x[p][k];
      if (u[p][k] > high) factor = std::min(factor, std::max(0.0, high) / u[p][k]);
      if (u[p][k] < low) factor = std::min(factor, std::min(0.0, low) / u[p][k]);
    }
    return factor;
  }

  /// Lowers factors of vertices to that of their group.
  void join_groups(std::vector<double>& by) const {
    if (limits.groups.empty()) return;
    std::vector<double> of_group;
    for (std::size_t v = 0; v < by.size(); ++v) {
      if (limits.groups[v] < 0) continue;
      const auto g = static_cast<std::size_t>(limits.groups[v]);
      if (g >= of_group.size()) of_group.resize(g + 1, 1);
      of_group[g] = std::min(of_group[g], by[v]);
    }
    for (std::size_t v = 0; v < by.size(); ++v)
      if (limits.groups[v] >= 0) by[v] = of_group[static_cast<std::size_t>(limits.groups[v])];
  }

  /// Shortens steps by the factors of the vertices (#V); returns how many.
  std::size_t shorten(const std::vector<double>& by, Vectors dq) {
    std::size_t count = 0;
    for (std::size_t v = 0; v < dq.size(); ++v) {
      if (by[v] >= 1) continue;
      ++count;
      dq[v] *= by[v];
      mark(v);
    }
    return count;
  }

  void lower(std::vector<double>& by, int point, double factor) const {
    for (const SurfaceMap::Entry& e : map.row(static_cast<std::size_t>(point))) {
      double& f = by[static_cast<std::size_t>(e.vertex)];
      f = std::min(f, factor);
    }
  }

  std::size_t clip(Vectors dq) {
    std::vector<double> by(dq.size());
    std::size_t count = 0;
    // Shortening one of several vertices may move a point out of its box again: repeat until none is out.
    for (std::size_t round = 0;; ++round) {
      map.apply(dq, u);
      const auto outside = parallel_collect<std::pair<int, double>>(
          map.point_count(), limit_grain, [&](auto begin, auto end, auto& out) {
            for (std::size_t p = begin; p < end; ++p)
              if (const double factor = factor_within_box(p); factor < 1)
                out.emplace_back(static_cast<int>(p), factor);
          });
      if (outside.empty()) return count;
      std::fill(by.begin(), by.end(), 1.0);
      for (const auto& [point, factor] : outside)
        lower(by, point, round < last_rounds ? factor * (1 - 1e-9) : 0);
      join_groups(by);
      count = std::max(count, shorten(by, dq));
    }
  }

  void advance(Vectors dq, LimitReport& report) {
    std::vector<double> by(dq.size()), total(dq.size(), 1);
    while (judge(dq)) {
      const std::size_t round = report.rounds++;
      std::fill(by.begin(), by.end(), 1.0);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (factors[i] >= 1) continue;
        const double share = round < patient_rounds ? given_share : round < last_rounds ? 0.5 : 0;
        for (int k = 0; k < pairs[i].point_count(); ++k)
          lower(by, pairs[i].points[static_cast<std::size_t>(k)], share * factors[i]);
      }
      join_groups(by);
      shorten(by, dq);
      for (std::size_t v = 0; v < dq.size(); ++v) total[v] *= by[v];
    }
    for (const double t : total) {
      report.shortened += t < 1 ? 1 : 0;
      report.smallest_factor = std::min(report.smallest_factor, t);
    }
  }
};

StepLimiter::StepLimiter(std::shared_ptr<const SurfaceMap> map, StepLimits limits)
    : map_(std::move(map)), limits_(std::move(limits)) {
  if (!(limits_.gap_floor > 0))
    throw Error(ErrorKind::usage, "the gap floor is not positive", "give a length in metres");
  if (!(limits_.kept_share >= 0 && limits_.kept_share < 1))
    throw Error(ErrorKind::usage, "the share of gaps to keep is not within 0 and 1",
                "give 0 or a little more");
  const auto fits = [&](std::size_t size) { return size == 0 || size == map_->vertex_count(); };
  if (!fits(limits_.prescribed.size()) || !fits(limits_.groups.size()))
    throw Error(ErrorKind::usage, "a step limiter needs one entry for each vertex", "give #V or none");
}

LimitReport StepLimiter::limit(PairDistances& at, Vectors dq, std::span<const std::uint8_t> held) const {
  if (held.empty()) held = limits_.prescribed;
  if (dq.size() != map_->vertex_count() || at.points().size() != map_->point_count())
    throw Error(ErrorKind::usage, "a step limiter needs one step for each vertex", "give #V steps");
  LimitReport report;
  Work work(*map_, limits_, held, at);
  std::vector<std::uint8_t> deflected(dq.size(), 0);
  // Vertices first: features sliding over a sheet would otherwise be stopped by the edges they pass.
  for (int round = 0; round < deflections && work.judge(dq); ++round) {
    const auto chosen = [round](PairKind kind) {
      return round > 1 || (kind == PairKind::edge_edge) == (round == 1);
    };
    work.deflect(dq, chosen, deflected);
  }
  report.deflected = static_cast<std::size_t>(std::count(deflected.begin(), deflected.end(), 1));
  report.clipped = work.clip(dq);
  work.advance(dq, report);
  return report;
}

}  // namespace muslin
