#include "muslin/contact/contact_guard.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "muslin/contact/intersections.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/core/stopwatch.hpp"
#include "muslin/potential/stopping_time.hpp"

namespace muslin {
namespace {

constexpr std::size_t guard_grain = 4096;
/// Boxes of candidates are wider than the motion by this share of d̂.
constexpr double margin_share = 0.5;
/// If at most this share of the points leaves its boxes, only their candidates are updated.
constexpr double renewed_share = 0.3;
/// Pushed vertices move at most this much farther than the pushing ones, along slanting normals.
constexpr double pushed_share = 1.5;
/// Displacements of more edges than this are limited in pieces, at most `max_pieces`.
constexpr double edges_at_once = 2;
constexpr int max_pieces = 256;
/// Most rounds of limiting a displacement; each updates the candidates of points that left their boxes. Two
/// or three usually suffice; otherwise the displacement is set to zero.
constexpr int max_rounds = 32;
/// Prescribed vertices move this share of that at once: the search covers all vertices they might push.
constexpr double pushed_at_once = 0.125;
/// Assumed edge length in contact distances if no body is deformable.
constexpr double edge_distances = 5;
/// Share of the model's gap floor that is kept; contact resists any load.
constexpr double floor_share = 0.01;
/// Motions below this share of that floor need no limit.
constexpr double slack_share = 1e-4;
/// Share of gaps that an iteration keeps. An iteration that ends with some edges at a thousandth of the range
/// produces forces there that dwarf all others and recovers only half of the gap per iteration, which stops
/// all motion coupled to such gaps.
constexpr double kept_share = 0.3;
/// Groups that move less than this share of the gap between them are not limited.
constexpr double safe_share = 0.5;
/// Slip at which friction is full, as a share of the range; independent of the step, so that bodies at rest
/// do not move when it changes.
constexpr double stick_share = 0.005;

/// Returns the mean edge length of deformable bodies.
double mean_edge(const ContactModel& model) {
  const ContactSurface& surface = *model.surface;
  const auto bends = [&](int point) {
    if (surface.body_at(point).fixed) return false;
    const auto row = model.map->row(static_cast<std::size_t>(point));
    return std::all_of(row.begin(), row.end(), [&](const SurfaceMap::Entry& e) {
      return model.limits.groups.empty() || model.limits.groups[static_cast<std::size_t>(e.vertex)] < 0;
    });
  };
  double sum = 0;
  int count = 0;
  for (const ContactSurface::Edge& e : surface.edges()) {
    if (!bends(e[0])) continue;
    sum += (model.rest[static_cast<std::size_t>(e[0])] - model.rest[static_cast<std::size_t>(e[1])]).norm();
    ++count;
  }
  return count > 0 ? sum / count : edge_distances * model.distance;
}

StepLimits limits_of(const ContactModel& model) {
  StepLimits limits = model.limits;
  limits.gap_floor *= floor_share;
  limits.kept_share = kept_share;
  return limits;
}

}  // namespace

void require_fit(const ContactMemory& memory, const ContactModel& model) {
  const std::size_t points = model.map->point_count();
  const auto triangles = static_cast<int>(model.surface->triangles().size());
  const bool fits =
      memory.begin.size() == memory.end.size() && (memory.begin.empty() || memory.begin.size() == points) &&
      std::all_of(memory.tangled.begin(), memory.tangled.end(), [&](const std::array<int, 2>& pair) {
        return pair[0] >= 0 && pair[0] < triangles && pair[1] >= 0 && pair[1] < triangles;
      });
  if (!fits)
    throw Error(ErrorKind::input, "the checkpoint's contact belongs to other surfaces", "restart the run");
}

ContactGuard::ContactGuard(std::shared_ptr<const ContactModel> model, ContactMemory& memory)
    : model_(std::move(model)),
      memory_(memory),
      candidates_(model_->surface, model_->rest, model_->distance),
      distances_(candidates_),
      limiter_(model_->map, limits_of(*model_)),
      margin_(margin_share * candidates_.longest_range()),
      edge_(mean_edge(*model_)),
      longest_(std::max(edges_at_once * edge_, 4 * candidates_.longest_range())),
      longest_push_(pushed_at_once * longest_),
      friction_{model_->friction.at(0), stick_share * model_->surface->ranges(model_->distance)[0],
                stopping_time},
      x_(model_->map->point_count()),
      to_(model_->map->point_count()) {
  for (const ContactBody& body : model_->surface->bodies()) {
    if (*std::max_element(body.frame.begin(), body.frame.end()) >=
        static_cast<int>(model_->map->vertex_count()))
      throw Error(ErrorKind::usage, "a body's frame has a vertex that does not exist", "check the indices");
  }
  require_fit(memory_, *model_);
  candidates_.ignore_pairs(memory_.tangled, model_->exempt);
  candidates_.apply_rules(memory_.rules);
  rebuild();
}

void ContactGuard::follow_time(ConstVectors q, double begin, double end) {
  friction_.coefficient = model_->friction.at(end);
  friction_.time = end;
  const ContactRules& rules = model_->surface->rules();
  const ContactRules::Set now = rules.in_force(begin + (end - begin) / 2);
  if (now == memory_.rules && rules.hash() == memory_.rules_hash) return;
  memory_.rules = now;
  memory_.rules_hash = rules.hash();
  candidates_.apply_rules(now);
  free_crossings(q);
}

void ContactGuard::free_crossings(ConstVectors q) {
  memory_.tangled = crossing(q);
  candidates_.ignore_pairs(memory_.tangled, model_->exempt);
  memory_.begin.clear();
  memory_.end.clear();
  renewed_ = false;
}

void ContactGuard::begin(ConstVectors q, std::span<const std::uint8_t> held) {
  forget_renewed();
  start_.assign(q.begin(), q.end());
  held_.assign(held.begin(), held.end());
}

void ContactGuard::find_candidates(ConstVectors begin, ConstVectors end, double margin) {
  const Stopwatch watch(counts_.search_seconds);
  ++counts_.searches;
  memory_.begin.assign(begin.begin(), begin.end());
  memory_.end.assign(end.begin(), end.end());
  memory_.margin = margin;
  renewed_ = false;
  candidates_.update(begin, end, margin, edge_);
  distances_.forget();
}

/// Updates the distances to q.
void ContactGuard::measure(ConstVectors q) {
  model_->map->apply(q, x_);
  distances_.update(x_);
}

/// Sets outside_ where `inside` is false of a point and its box; returns the number of such points. Calls it
/// once for each point, on any thread.
template <class Inside>
std::size_t ContactGuard::find_outside(const Inside& inside) {
  outside_.resize(x_.size());
  return parallel_sum(x_.size(), guard_grain, std::size_t{0}, [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t p = begin; p < end; ++p) {
      outside_[p] = inside(p, candidates_.boxes().end(p)) ? 0 : 1;
      count += outside_[p];
    }
    return count;
  });
}

/// Ensures that all pairs are known for the motion from q to q + d, and for vertices pushed aside by held
/// vertices, which move about as far as those.
void ContactGuard::ensure_coverage(ConstVectors q, ConstVectors d) {
  double push = 0;
  for (std::size_t v = 0; v < held_.size(); ++v)
    if (held_[v] != 0) push = std::max(push, d[v].norm());
  reach_ = margin_ + pushed_share * push;
  model_->map->apply(q, x_);
  model_->map->apply(d, to_);
  parallel_for(x_.size(), guard_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) to_[p] += x_[p];
  });
  if (memory_.begin.empty()) return find_candidates(x_, to_, reach_);
  const double pushed = reach_ - margin_;
  const std::size_t count = find_outside([&](std::size_t p, const PointBox& box) {
    return (x_[p].cwiseMin(to_[p]).array() - pushed >= box.lower.array()).all() &&
           (x_[p].cwiseMax(to_[p]).array() + pushed <= box.upper.array()).all();
  });
  if (static_cast<double>(count) > renewed_share * static_cast<double>(x_.size()))
    return find_candidates(x_, to_, reach_);
  if (count > 0) renew();
}

/// Updates the candidates of the points outside_, which stay between x_ and to_.
void ContactGuard::renew() {
  const Stopwatch watch(counts_.search_seconds);
  ++counts_.searches;
  candidates_.renew(outside_, x_, to_, reach_);
  distances_.forget();
  renewed_ = true;
}

/// Returns true if the limited displacement takes points out of their boxes, which were made for the original
/// one; their candidates are then updated.
bool ContactGuard::requery_clamped(ConstVectors d) {
  model_->map->apply(d, to_);
  const std::size_t count = find_outside([&](std::size_t p, const PointBox& box) {
    to_[p] += x_[p];
    return box.contains(to_[p]);
  });
  if (count > 0) renew();
  return count > 0;
}

/// Clears memory_ if it does not match the candidates, since a resumed run finds them from it.
void ContactGuard::forget_renewed() {
  if (!renewed_) return;
  memory_.begin.clear();
  memory_.end.clear();
  renewed_ = false;
}

/// Shortens displacements far beyond an edge's length, which are solver artefacts and would make all pairs
/// candidates.
void ContactGuard::shorten(Vectors d) const {
  const StepLimits& limits = model_->limits;
  std::vector<double> of_group;
  for (std::size_t v = 0; v < d.size(); ++v) {
    const double length = d[v].norm(), longest = held_[v] != 0 ? longest_push_ : longest_;
    if (!(length > longest)) continue;
    const double factor = longest / length;
    if (limits.groups.empty() || limits.groups[v] < 0) {
      d[v] *= factor;
      continue;
    }
    const auto g = static_cast<std::size_t>(limits.groups[v]);
    if (g >= of_group.size()) of_group.resize(g + 1, 1);
    of_group[g] = std::min(of_group[g], factor);
  }
  if (of_group.empty()) return;
  for (std::size_t v = 0; v < d.size(); ++v) {
    const int g = limits.groups[v];
    if (g >= 0 && static_cast<std::size_t>(g) < of_group.size())
      d[v] *= of_group[static_cast<std::size_t>(g)];
  }
}

void ContactGuard::limit(ConstVectors q, Vectors d) {
  shorten(d);
  ensure_coverage(q, d);
  ++counts_.limits;
  for (int round = 0; round < max_rounds; ++round) {
    {
      const Stopwatch watch(counts_.limit_seconds);
      measure(q);
      const LimitReport report = limiter_.limit(distances_, d, held_);
      counts_.deflected += report.deflected;
      counts_.shortened += report.shortened;
    }
    if (!requery_clamped(d)) return;
  }
  std::fill(d.begin(), d.end(), Vec3::Zero());
}

void ContactGuard::limit(ConstVectors q, Vectors d, std::span<const int> groups) {
  ensure_coverage(q, d);
  measure(q);
  std::vector<double> moves;  // by group, the farthest
  for (std::size_t v = 0; v < d.size(); ++v) {
    if (groups[v] < 0) continue;
    const auto g = static_cast<std::size_t>(groups[v]);
    if (g >= moves.size()) moves.resize(g + 1, 0);
    moves[g] = std::max(moves[g], d[v].norm());
  }
  std::vector<std::uint8_t> tight(moves.size(), 0);
  const std::span<const ContactPair> pairs = candidates_.pairs();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto group_of = [&](std::size_t k) {
      const auto row = model_->map->row(static_cast<std::size_t>(pairs[i].points[k]));
      return row.empty() ? -1 : groups[static_cast<std::size_t>(row[0].vertex)];
    };
    const int a = group_of(0), b = group_of(static_cast<std::size_t>(first_feature_size(pairs[i].kind)));
    if (a == b) continue;
    const double way =
        (a < 0 ? 0 : moves[static_cast<std::size_t>(a)]) + (b < 0 ? 0 : moves[static_cast<std::size_t>(b)]);
    const auto gap = [&] { return distances_[i].distance - pairs[i].thickness; };
    if (way <= safe_share * gap()) continue;
    distances_.find(i);
    if (way <= safe_share * gap()) continue;
    if (a >= 0) tight[static_cast<std::size_t>(a)] = 1;
    if (b >= 0) tight[static_cast<std::size_t>(b)] = 1;
  }
  if (std::find(tight.begin(), tight.end(), 1) == tight.end()) return;
  const std::vector<Vec3> whole(d.begin(), d.end());
  limit(q, d);
  for (std::size_t v = 0; v < d.size(); ++v)
    if (groups[v] >= 0 && tight[static_cast<std::size_t>(groups[v])] == 0) d[v] = whole[v];
}

void ContactGuard::advance(Vectors q, ConstVectors d) {
  double farthest = 0;  // in pieces
  for (std::size_t v = 0; v < d.size(); ++v)
    farthest = std::max(farthest, d[v].norm() / (held_[v] != 0 ? longest_push_ : longest_));
  const double needed = std::ceil(farthest);
  const int pieces = needed < max_pieces ? std::max(1, static_cast<int>(needed)) : max_pieces;
  const std::vector<Vec3> from(q.begin(), q.end());
  piece_.resize(q.size());
  for (int k = 1; k <= pieces; ++k) {
    for (std::size_t v = 0; v < q.size(); ++v) {
      // Prescribed vertices catch up after being held back; pushed vertices do not return.
      const bool prescribed = held_[v] != 0;
      piece_[v] =
          prescribed ? Vec3(from[v] + static_cast<double>(k) / pieces * d[v] - q[v]) : Vec3(d[v] / pieces);
    }
    limit(q, piece_);
    for (std::size_t v = 0; v < q.size(); ++v) q[v] += piece_[v];
  }
}

const Potential& ContactGuard::potential(ConstVectors q, StepGuard::Friction friction) {
  if (memory_.begin.empty()) {
    piece_.assign(q.size(), Vec3::Zero());
    ensure_coverage(q, piece_);
  }
  const Stopwatch watch(counts_.potential_seconds);
  measure(q);
  if (friction == StepGuard::Friction::anew) {
    potential_.emplace(distances_, model_->map, q, friction_, start_, memory_.slips);
  } else {
    const bool tangent = friction == StepGuard::Friction::kept_tangent;
    *potential_ = ContactPotential(distances_, model_->map, q, *potential_,
                                   tangent ? SlidingStiffness::tangent : SlidingStiffness::secant);
  }
  return *potential_;
}

/// Returns a length far below the gap that the limiter leaves.
double ContactGuard::slack() const { return slack_share * floor_share * model_->limits.gap_floor; }

void ContactGuard::for_each_contact(const std::function<void(const Contact&)>& visit) const {
  potential_->secant_hessian().for_each_row(visit);
}

void ContactGuard::end(ConstVectors q) {
  memory_.slips = potential_->slips(q);
  measure(q);
  memory_.smallest_gap = distances_.smallest_gap();
  if (!memory_.tangled.empty()) allow_initial_intersections(q);
  // Ignored pairs are not candidates. Triangles that cross have distance 0.
  const ContactSurface& surface = *model_->surface;
  const auto radius = [&](int t) {
    const Vec3i& corners = surface.triangles()[static_cast<std::size_t>(t)];
    return surface.radius_of(std::span<const int>(corners.data(), 3));
  };
  for (const auto& [first, second] : memory_.tangled)
    memory_.smallest_gap = std::min(memory_.smallest_gap, 0.0 - (radius(first) + radius(second)));
  forget_renewed();
}

/// Returns the pairs of triangles that cross at q.
std::vector<std::array<int, 2>> ContactGuard::crossing(ConstVectors q) {
  const ContactSurface& surface = *model_->surface;
  model_->map->apply(q, x_);
  IntersectionOptions options;
  options.wanted = [&](int a, int b) { return model_->forbids_crossing(a, b, memory_.rules); };
  std::vector<std::array<int, 2>> pairs;
  for (const Intersection& i : find_intersections(x_, surface.triangles(), options))
    pairs.push_back({i.first, i.second});
  return pairs;
}

void ContactGuard::allow_initial_intersections(ConstVectors q) {
  std::vector<std::array<int, 2>> now = crossing(q);
  if (now == memory_.tangled) return;
  memory_.tangled = std::move(now);
  candidates_.ignore_pairs(memory_.tangled, model_->exempt);
  rebuild();
}

void ContactGuard::leave_free(std::vector<std::array<int, 2>> crossing, FreeParts parts) {
  memory_.tangled = std::move(crossing);
  candidates_.ignore_pairs(memory_.tangled, model_->exempt);
  candidates_.ignore_parts(std::move(parts));
  rebuild();
}

void ContactGuard::rebuild() {
  if (memory_.begin.empty()) return;
  candidates_.update(memory_.begin, memory_.end, memory_.margin, edge_);
  distances_.forget();
}

}  // namespace muslin
