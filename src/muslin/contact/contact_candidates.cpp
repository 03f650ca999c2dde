#include "muslin/contact/contact_candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "muslin/contact/turning_plane.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t candidate_grain = 256;

/// Shares of a rest distance that thickness and range may take.
constexpr double rest_thickness = 0.5, rest_range = 0.4;

std::array<int, 4> points_of(const ContactSurface& surface, PairKind kind, int first, int second) {
  const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
  switch (kind) {
    case PairKind::vertex_triangle: {
      const Vec3i& t = surface.triangles()[b];
      return {first, t[0], t[1], t[2]};
    }
    case PairKind::edge_edge: {
      const auto &e = surface.edges()[a], &f = surface.edges()[b];
      return {e[0], e[1], f[0], f[1]};
    }
    default: {
      const ContactPlane& plane = surface.planes()[b];
      return {first, plane.point, plane.span[0], plane.span[1]};
    }
  }
}

std::vector<int> points_of_bodies(const ContactSurface& surface) {
  std::vector<int> sizes(surface.bodies().size(), 0);
  for (int p = 0; p < static_cast<int>(surface.point_count()); ++p)
    ++sizes[static_cast<std::size_t>(surface.body_of(p))];
  return sizes;
}

}  // namespace

PairGeometry pair_geometry(const ContactSurface& surface, const ContactPair& pair, ConstVectors x) {
  const auto at = [&](std::size_t i) -> const Vec3& { return x[static_cast<std::size_t>(pair.points[i])]; };
  if (pair.kind == PairKind::point_plane) {
    const ContactPlane& plane = surface.planes()[static_cast<std::size_t>(pair.second)];
    if (plane.turns()) {
      const OverPlane over = over_plane(std::array{at(0), at(1), at(2), at(3)});
      return {over.normal, over.distance, over.weights};
    }
    const Vec3& n = plane.normal;
    return {n, n.dot(at(0) - at(1)), {1, -1, 0, 0}};
  }
  const ClosestPoints c = pair.kind == PairKind::vertex_triangle
                              ? closest_vertex_triangle(at(0), at(1), at(2), at(3))
                              : closest_edge_edge(at(0), at(1), at(2), at(3));
  const double d = c.distance();
  return {d > 0 ? Vec3(c.difference / d) : Vec3(Vec3::Zero()), d, c.weights};
}

Vec3 visible_point(const ContactSurface& surface, const ContactPair& pair, const PairGeometry& geometry,
                   ConstVectors x) {
  const auto size = static_cast<std::size_t>(first_feature_size(pair.kind)),
             count = static_cast<std::size_t>(pair.point_count());
  const bool second_is_thinner =
      pair.kind != PairKind::point_plane &&
      surface.radius_of(pair.points[count - 1]) < surface.radius_of(pair.points[0]);
  Vec3 point = Vec3::Zero();
  for (std::size_t i = second_is_thinner ? size : 0; i < (second_is_thinner ? count : size); ++i)
    point += std::abs(geometry.weights[i]) * x[static_cast<std::size_t>(pair.points[i])];
  return point;
}

ContactCandidates::ContactCandidates(std::shared_ptr<const ContactSurface> surface, ConstVectors rest,
                                     double contact_distance)
    : surface_(std::move(surface)),
      contact_distance_(contact_distance),
      longest_range_(surface_->ranges(contact_distance)[1]),
      reach_(surface_->rules().thickest() + longest_range_),
      search_(surface_, rest) {
  if (!(contact_distance > 0))
    throw Error(ErrorKind::usage, "the contact distance is not positive", "give a length in metres");
  // Pairs that are close at rest within a body; boxes already include the radii.
  const std::vector<int> sizes = points_of_bodies(*surface_);
  const double thickest_rule = surface_->rules().thickest();
  double thickest = thickest_rule / rest_thickness;
  for (std::size_t body = 0; body < sizes.size(); ++body) {
    const ContactBody& b = surface_->bodies()[body];
    if (sizes[body] > 3 && b.self_contact && !b.fixed) thickest = std::max(thickest, 2 * b.radius);
  }
  boxes_ = MovingBoxes(rest.size());
  for (std::size_t p = 0; p < rest.size(); ++p) boxes_.stay(p, rest[p], rest[p], 0);
  search_.find(boxes_, std::max(thickest, longest_range_ / rest_range), found_);
  const auto note = [&](PairKind kind, int first, int second) {
    const std::array<int, 4> points = points_of(*surface_, kind, first, second);
    if (surface_->body_of(points[0]) != surface_->body_of(points[3])) return;
    const ContactPair pair = make_pair(kind, first, second);
    const double distance = pair_geometry(*surface_, pair, rest).distance;
    const bool is_ruled = !surface_->rules().empty();  // by rules that are not yet in force
    const double thickness = is_ruled ? std::max(pair.thickness, thickest_rule) : pair.thickness,
                 range = is_ruled ? longest_range_ : pair.range;
    if (rest_thickness * distance < thickness || rest_range * distance < range)
      rest_distances_.push_back({pair.key(), distance});
  };
  for (const VertexTriangle& p : found_.vertex_triangle) note(PairKind::vertex_triangle, p.point, p.triangle);
  for (const EdgeEdge& p : found_.edge_edge) note(PairKind::edge_edge, p.first, p.second);
  std::sort(rest_distances_.begin(), rest_distances_.end(),
            [](const RestDistance& a, const RestDistance& b) { return a.key < b.key; });
}

void ContactCandidates::limit_by_rest(ContactPair& pair) const {
  if (rest_distances_.empty()) return;
  const std::uint64_t key = pair.key();
  const auto found = std::lower_bound(rest_distances_.begin(), rest_distances_.end(), key,
                                      [](const RestDistance& r, std::uint64_t k) { return r.key < k; });
  if (found == rest_distances_.end() || found->key != key) return;
  pair.thickness = std::min(pair.thickness, rest_thickness * found->distance);
  pair.range = std::min(pair.range, rest_range * found->distance);
}

void ContactCandidates::free_edges(int e, int f) {
  if (e >= 0 && f >= 0)
    free_.push_back(ContactPair::key_of(PairKind::edge_edge, std::min(e, f), std::max(e, f)));
}

void ContactCandidates::ignore_pairs(std::span<const std::array<int, 2>> triangles,
                                     const ContactExemptions& joints) {
  free_.clear();
  for (const auto& [first, second] : triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
      free_.push_back(ContactPair::key_of(PairKind::vertex_triangle, surface_->triangles()[a][i], second));
      free_.push_back(ContactPair::key_of(PairKind::vertex_triangle, surface_->triangles()[b][i], first));
      for (int j = 0; j < 3; ++j)
        free_edges(surface_->triangle_edges()[a][i], surface_->triangle_edges()[b][j]);
    }
  }
  for (const auto& [point, triangle] : joints.point_triangles) {
    const auto b = static_cast<std::size_t>(triangle);
    free_.push_back(ContactPair::key_of(PairKind::vertex_triangle, point, triangle));
    for (const int t : surface_->triangles_at_point(point)) {
      const auto a = static_cast<std::size_t>(t);
      for (int i = 0; i < 3; ++i) {
        free_.push_back(ContactPair::key_of(PairKind::vertex_triangle, surface_->triangles()[b][i], t));
        const int e = surface_->triangle_edges()[a][i];
        if (e < 0) continue;
        const ContactSurface::Edge& ends = surface_->edges()[static_cast<std::size_t>(e)];
        if (ends[0] != point && ends[1] != point) continue;
        for (int j = 0; j < 3; ++j) free_edges(e, surface_->triangle_edges()[b][j]);
      }
    }
  }
  for (const auto& [point, plane] : joints.point_planes)
    free_.push_back(ContactPair::key_of(PairKind::point_plane, point, plane));
  std::sort(free_.begin(), free_.end());
}

bool ContactCandidates::is_free(PairKind kind, int first, int second) const {
  return !free_.empty() &&
         std::binary_search(free_.begin(), free_.end(), ContactPair::key_of(kind, first, second));
}

bool ContactCandidates::has_free_points(PairKind kind, const std::array<int, 4>& points) const {
  if (free_parts_.empty()) return false;
  const auto size = static_cast<std::size_t>(first_feature_size(kind));
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = size; j < 4; ++j)
      if (free_parts_.has(points[i], points[j])) return true;
  return false;
}

ContactPair ContactCandidates::make_pair(PairKind kind, int first, int second) const {
  ContactPair pair;
  pair.kind = kind;
  pair.first = first;
  pair.second = second;
  pair.points = points_of(*surface_, kind, first, second);
  const std::span<const int> points(pair.points.data(), static_cast<std::size_t>(pair.point_count()));
  const auto size = static_cast<std::size_t>(first_feature_size(kind));
  pair.thickness = surface_->radius_of(points.first(size)) + surface_->radius_of(points.subspan(size));
  pair.range = surface_->range(points.front(), points.back(), contact_distance_);
  if (active_rules_ != 0) follow_rule(pair);
  limit_by_rest(pair);
  return pair;
}

void ContactCandidates::follow_rule(ContactPair& pair) const {
  const auto size = static_cast<std::size_t>(first_feature_size(pair.kind)),
             count = static_cast<std::size_t>(pair.point_count());
  const std::span<const int> points(pair.points.data(), count);
  const int found = surface_->rules().find(points.first(size), points.subspan(size), active_rules_);
  if (found < 0) return;
  pair.rule = static_cast<std::int8_t>(found);
  const ContactRule& rule = surface_->rules()[found];
  const auto radius = [&](int point) { return surface_->is_round(point) ? surface_->radius_of(point) : 0; };
  if (rule.thickness) pair.thickness = *rule.thickness + radius(points.front()) + radius(points.back());
  if (rule.range) pair.range = *rule.range;
}

template <class Pair>
void ContactCandidates::add_near(PairKind kind, std::span<const Pair> found, Near& out) const {
  std::vector<std::array<int, 4>> points(found.size());
  std::vector<float> distances(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto [first, second] = found[i];
    points[i] = points_of(*surface_, kind, first, second);
  }
  culling_.find_near(kind, points, reach_, distances.data());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto [first, second] = found[i];
    if (distances[i] < 0 || is_free(kind, first, second) || has_free_points(kind, points[i])) continue;
    const ContactPair pair = make_pair(kind, first, second);
    if (passes(pair)) continue;
    out.pairs.push_back(pair);
    out.distances.push_back(distances[i]);
  }
}

void ContactCandidates::update(ConstVectors begin, ConstVectors end, double margin, double long_way) {
  const std::size_t points = surface_->point_count();
  if (begin.size() != points || end.size() != points)
    throw Error(ErrorKind::usage, "contact candidates need one position for each point", "give #P positions");
  found_at_.assign(begin.begin(), begin.end());
  // Boxes around whole displacements are faster to compare, and as tight while displacements are short.
  double farthest = 0;
  for (std::size_t p = 0; p < points; ++p) farthest = std::max(farthest, (end[p] - begin[p]).squaredNorm());
  boxes_.restart();
  const bool slow = farthest <= long_way * long_way;
  for (std::size_t p = 0; p < points; ++p) {
    if (slow) {
      boxes_.stay(p, begin[p], end[p], margin);
    } else {
      boxes_.move(p, begin[p], end[p], margin);
    }
  }
  search_.find(boxes_, reach_, found_);
  culling_.set_points(*surface_, found_at_, boxes_);
  pairs_.clear();
  least_distances_.clear();
  add_near_pairs();
}

void ContactCandidates::renew(std::span<const std::uint8_t> moved, ConstVectors begin, ConstVectors end,
                              double margin) {
  const auto has_moved = [&](int p) { return moved[static_cast<std::size_t>(p)] != 0; };
  for (std::size_t p = 0; p < moved.size(); ++p)
    if (moved[p] != 0) boxes_.stay(p, begin[p], end[p], margin);
  search_.find(boxes_, reach_, found_, moved);
  culling_.set_boxes(moved, boxes_);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const std::array<int, 4>& p = pairs_[i].points;
    if (pairs_[i].kind == PairKind::point_plane || has_moved(p[0]) || has_moved(p[1]) || has_moved(p[2]) ||
        has_moved(p[3]))
      continue;
    pairs_[kept] = pairs_[i];
    least_distances_[kept++] = least_distances_[i];
  }
  pairs_.resize(kept);
  least_distances_.resize(kept);
  add_near_pairs();
}

/// Collects near pairs from those of the search and from planes.
void ContactCandidates::add_near_pairs() {
  const auto blocks = [](std::size_t count) { return (count + candidate_grain - 1) / candidate_grain; };
  const std::size_t vertex_triangle = blocks(found_.vertex_triangle.size());
  std::vector<Near> parts(vertex_triangle + blocks(found_.edge_edge.size()));
  parallel_for(parts.size(), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const auto block = [](const auto& all, std::size_t k) {
        return std::span(all).subspan(k * candidate_grain,
                                      std::min(candidate_grain, all.size() - k * candidate_grain));
      };
      if (i < vertex_triangle) {
        add_near(PairKind::vertex_triangle, block(found_.vertex_triangle, i), parts[i]);
      } else {
        add_near(PairKind::edge_edge, block(found_.edge_edge, i - vertex_triangle), parts[i]);
      }
    }
  });
  for (const Near& part : parts) {
    pairs_.insert(pairs_.end(), part.pairs.begin(), part.pairs.end());
    least_distances_.insert(least_distances_.end(), part.distances.begin(), part.distances.end());
  }
  for (std::size_t k = 0; k < surface_->planes().size(); ++k) add_near_plane(static_cast<int>(k));
  least_distances_.resize(pairs_.size(), 0);
}

void ContactCandidates::add_near_plane(int plane) {
  const ContactPlane& half_space = surface_->planes()[static_cast<std::size_t>(plane)];
  if (half_space.turns()) return add_near_turning_plane(plane);
  const auto carrier = static_cast<std::size_t>(half_space.point);
  const Vec3 &n = half_space.normal, extent = n.cwiseAbs();
  const PointBox of_plane = boxes_.around(carrier);
  const double top = n.dot(of_plane.middle()) + extent.dot(of_plane.half());
  const double radius = surface_->radius_of(half_space.point) + reach_;
  for (std::size_t p = 0; p < boxes_.size(); ++p) {
    const int point = static_cast<int>(p);
    const PointBox box = boxes_.around(p);
    const double bottom = n.dot(box.middle()) - extent.dot(box.half());
    if (bottom - top > radius + surface_->radius_of(point) || p == carrier) continue;
    if (is_free(PairKind::point_plane, point, plane)) continue;
    if (!surface_->may_touch(surface_->body_of(point), surface_->body_of(half_space.point))) continue;
    const ContactPair pair = make_pair(PairKind::point_plane, point, plane);
    if (!passes(pair)) pairs_.push_back(pair);
  }
}

/// Boxes of half diagonal r around the plane's points a, b, c turn N = (b − a) × (c − a) by no more than
/// |δN| = 2r (|b − a| + |c − a|) + 4r², and so n by no more than 2 |δN| / |N|.
void ContactCandidates::add_near_turning_plane(int plane) {
  const ContactPlane& half_space = surface_->planes()[static_cast<std::size_t>(plane)];
  const auto middle = [&](int point) { return boxes_.around(static_cast<std::size_t>(point)).middle(); };
  const auto half = [&](int point) { return boxes_.around(static_cast<std::size_t>(point)).half().norm(); };
  const Vec3 a = middle(half_space.point), u = middle(half_space.span[0]) - a,
             v = middle(half_space.span[1]) - a, n = u.cross(v);
  const double r = std::max({half(half_space.point), half(half_space.span[0]), half(half_space.span[1])});
  const double turn = 2 * (2 * r * (u.norm() + v.norm()) + 4 * r * r) / n.norm();
  const double radius = surface_->radius_of(half_space.point) + reach_;
  for (int point = 0; point < static_cast<int>(boxes_.size()); ++point) {
    if (!surface_->may_touch(surface_->body_of(point), surface_->body_of(half_space.point)) ||
        is_free(PairKind::point_plane, point, plane))
      continue;
    const Vec3 away = middle(point) - a;
    const double reach = half(point) + r;
    const double least = n.dot(away) / n.norm() - reach - turn * (away.norm() + reach);
    if (least > radius + surface_->radius_of(point)) continue;
    const ContactPair pair = make_pair(PairKind::point_plane, point, plane);
    if (!passes(pair)) pairs_.push_back(pair);
  }
}

}  // namespace muslin
