#include "muslin/untangle/tangle.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "muslin/contact/intersections.hpp"
#include "muslin/core/hash.hpp"
#include "muslin/core/index.hpp"
#include "muslin/untangle/crossed_regions.hpp"
#include "muslin/untangle/piercings.hpp"
#include "muslin/untangle/solid_insides.hpp"

namespace muslin {
namespace {

/// Surfaces are pushed apart until their gap is this share of the range, where contact hardly acts.
constexpr double gap_share = 0.5;
/// A sided pair with this share is apart: contact there is calm.
constexpr double calm_share = 0.02;
/// Contours become shorter in steps of this share of an edge.
constexpr double edge_share = 0.25;
/// Points on a wrong side come back by this many edges in a step.
constexpr double edges_at_once = 0.5;
/// Least sine between an edge and the triangle that it pierces, in the direction of shortening.
constexpr double least_sine = 0.1;
/// Least cosine between the line of a sided pair and the right side for that line to tell the side.
constexpr double clear_cosine = 0.3;
/// Sided pairs whose cosine is above this are kept from crossing before they are too close.
constexpr double facing_cosine = 0.5;
constexpr double perturbation = 1e-9;  // over the size of the surface

}  // namespace

class TangleFinder::Search {
 public:
  Search(TangleFinder& finder, ConstVectors q, double dt, double firmness)
      : model_(*finder.model_),
        surface_(*model_.surface),
        pieces_(finder.pieces_),
        candidates_(finder.candidates_),
        layerings_(finder.layerings_),
        sided_(finder.sided_),
        rules_(surface_.rules().in_force(0)),
        dt_(dt),
        firmness_(firmness),
        x_(surface_.point_count()) {
    model_.map->apply(q, x_);
  }

  Tangle find(bool flattens) {
    tangle_.free.parts.reserve(surface_.point_count());
    for (std::size_t p = 0; p < surface_.point_count(); ++p)
      tangle_.free.parts.push_back(pieces_.of_point(static_cast<int>(p)));
    tangle_.free.free_of.assign(surface_.point_count(), -1);
    find_crossing();
    perturb();
    const std::vector<Piercing> piercings = find_piercings(surface_, x_, tangle_.crossing);
    add_lost(find_solid_insides(surface_, pieces_, x_, tangle_.crossing));
    add_lost(find_crossed_regions(surface_, pieces_, x_, piercings, layerings_));
    find_sided();
    add_piercings(piercings);
    add_close();
    add_folds(flattens);
    for (const auto& [first, second] : sided_) tangle_.free.pairs.push_back({first, second});
    return std::move(tangle_);
  }

 private:
  void find_crossing() {
    IntersectionOptions options;
    options.wanted = [&](int a, int b) { return model_.forbids_crossing(a, b, rules_); };
    for (const Intersection& i : find_intersections(x_, surface_.triangles(), options))
      tangle_.crossing.push_back({i.first, i.second});
  }

  /// Moves points by a tiny part of the surface's size, each its own way. Meshes made of one grid cross edge
  /// to edge, where no edge passes strictly through a triangle; contours are whole in general position.
  void perturb() {
    Eigen::AlignedBox3d box;
    for (const Vec3& x : x_) box.extend(x);
    const double size = perturbation * box.diagonal().norm();
    for (std::size_t p = 0; p < x_.size(); ++p) {
      for (int k = 0; k < 3; ++k) {
        const std::array number = {static_cast<std::uint64_t>(p), static_cast<std::uint64_t>(k)};
        const std::uint64_t hash = hash_bytes(number.data(), sizeof number);
        x_[p][k] += size * (static_cast<double>(hash % 1000001) / 500000.0 - 1);
      }
    }
  }

  static std::pair<int, int> ordered(int a, int b) { return std::minmax(a, b); }

  /// Adds the pairs of pieces that are tangled and whose right sides are known.
  void find_sided() {
    const auto add_pair = [&](int a, int b) {
      if (a < 0 || b < 0 || a == b) return;
      if (pieces_.is_solid(a) || pieces_.is_solid(b)) {
        sided_.insert(ordered(a, b));
      } else if (const auto found = layerings_.find(ordered(a, b)); found != layerings_.end()) {
        if (found->second.layers) sided_.insert(ordered(a, b));
      }
    };
    for (const LostPoint& lost : tangle_.wrong) add_pair(pieces_.of_point(lost.point), lost.piece);
    for (const auto& [first, second] : tangle_.crossing)
      add_pair(pieces_.of_triangle(first), pieces_.of_triangle(second));
  }
  bool is_sided(int a, int b) const { return sided_.contains(ordered(a, b)); }

  /// Returns the direction from a triangle to the right side of it for another piece, of length 1.
  Vec3 right_side(int triangle, int other) const {
    const int piece = pieces_.of_triangle(triangle);
    if (pieces_.is_solid(piece)) return normal(triangle);
    if (pieces_.is_solid(other)) return Vec3::Zero();
    const Layering& sides = layerings_.at(ordered(piece, other));
    return (other < piece ? -sides.wrong_of_first : -sides.wrong_of_second) * normal(triangle);
  }

  double gap(int point, int other) const {
    return surface_.radius_of(point) + surface_.radius_of(other) + gap_share * model_.distance;
  }

  /// Leaves out what has no direction, at triangles without area, and what nothing can push.
  void add(const Separation& s) {
    if (!s.normal.allFinite() || !std::isfinite(s.stiffness)) return;
    tangle_.separations.push_back(s);
    tangle_.separations.back().stiffness *= firmness_;
  }

  void add_lost(std::span<const LostPoint> all) {
    for (const LostPoint& lost : all) {
      const Vec3i& t = surface_.triangles()[at(lost.triangle)];
      if (tangle_.free.free_of[at(lost.point)] >= 0) continue;
      if (surface_.rules().parts({&lost.point, 1}, {t.data(), 3}, rules_)) continue;
      tangle_.free.free_of[at(lost.point)] = lost.piece;
      tangle_.wrong.push_back(lost);
      tangle_.depth = std::max(tangle_.depth, lost.depth);
      const double edge = (x_[at(t[1])] - x_[at(t[0])]).norm();
      Separation s;
      s.normal = lost.out;
      s.gap = std::min(gap(lost.point, t[0]), edges_at_once * edge - lost.depth);
      s.stiffness = surface_.stiffness(lost.point, t[0], dt_);
      if (surface_.body_at(lost.point).fixed) {
        s.points = {lost.point, t[0], t[1], t[2]};
        s.weights = {1, -lost.barycentric[0], -lost.barycentric[1], -lost.barycentric[2]};
      } else {
        // Only the point moves: many points would drag along the few triangles that they have to pass.
        const Vec3 passed = lost.barycentric[0] * x_[at(t[0])] + lost.barycentric[1] * x_[at(t[1])] +
                            lost.barycentric[2] * x_[at(t[2])];
        s.points[0] = lost.point;
        s.weights[0] = 1;
        s.gap += s.normal.dot(passed);
      }
      add(s);
    }
  }

  Vec3 normal(int triangle) const {
    const Vec3i& t = surface_.triangles()[at(triangle)];
    return (x_[at(t[1])] - x_[at(t[0])]).cross(x_[at(t[2])] - x_[at(t[0])]).normalized();
  }

  /// Adds piercings of which no lost point takes care.
  void add_piercings(std::span<const Piercing> all) {
    std::map<std::pair<int, int>, std::vector<int>> contours;  // by pair of triangles
    for (std::size_t i = 0; i < all.size(); ++i)
      for (const int t : surface_.triangles_at_edge(all[i].edge))
        contours[std::minmax(t, all[i].triangle)].push_back(static_cast<int>(i));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Piercing& p = all[i];
      const ContactSurface::Edge& e = surface_.edges()[at(p.edge)];
      const Vec3i& t = surface_.triangles()[at(p.triangle)];
      const int of_edge = pieces_.of_point(e[0]), of_triangle = pieces_.of_triangle(p.triangle);
      const auto is_lost = [&](int point, int piece) { return tangle_.free.free_of[at(point)] == piece; };
      if (is_lost(e[0], of_triangle) || is_lost(e[1], of_triangle) || is_lost(t[0], of_edge) ||
          is_lost(t[1], of_edge) || is_lost(t[2], of_edge))
        continue;
      Vec3 way;  // of the edge over the triangle
      double length = gap(e[0], t[0]);
      if (is_sided(of_edge, of_triangle)) {
        way = right_side(p.triangle, of_edge);
        if (!(way.norm() > 0))
          for (const int side : surface_.triangles_at_edge(p.edge)) way -= right_side(side, of_triangle);
      } else {
        way = shortening(all, i, contours);
        length += edge_share * (x_[at(e[1])] - x_[at(e[0])]).norm();
      }
      if (!(way.norm() > 0)) continue;
      way.normalize();
      // Four points: the edge's end nearer to the piercing, and the triangle.
      const std::size_t end = p.along > 0.5 ? 1 : 0;
      Separation s;
      s.points = {e[end], t[0], t[1], t[2]};
      s.weights = {1, -p.barycentric[0], -p.barycentric[1], -p.barycentric[2]};
      s.normal = way;
      s.gap = way.dot(x_[at(e[end])] - p.at) + length;
      s.stiffness = surface_.stiffness(e[0], t[0], dt_);
      add(s);
    }
  }

  /// Returns the direction in which the edge of piercing i has to move over its triangle for the contour to
  /// become shorter: the contour ends at this edge, and its next corners are in directions R along the edge's
  /// triangles. With E along the edge and N normal to the triangle, a motion D of the edge moves the corner
  /// by D − (D·N)/(E·N) E, and the contour shortens most for D = Σ (R − (E·R)/(E·N) N).
  Vec3 shortening(std::span<const Piercing> all, std::size_t i,
                  const std::map<std::pair<int, int>, std::vector<int>>& contours) const {
    const Piercing& p = all[i];
    const ContactSurface::Edge& edge = surface_.edges()[at(p.edge)];
    const Vec3 e = (x_[at(edge[1])] - x_[at(edge[0])]).normalized(), n = normal(p.triangle);
    double sine = e.dot(n);
    if (std::abs(sine) < least_sine) sine = sine < 0 ? -least_sine : least_sine;
    Vec3 sum = Vec3::Zero();
    const auto add_end = [&](const Vec3& end) {
      const Vec3 along = end - p.at;
      if (!(along.norm() > 0)) return;
      const Vec3 r = along.normalized();
      sum += r - e.dot(r) / sine * n;
    };
    for (const int side : surface_.triangles_at_edge(p.edge)) {
      for (const int other : contours.at(std::minmax(side, p.triangle)))
        if (other != static_cast<int>(i)) add_end(all[at(other)].at);
      // The contour of two triangles with a common corner ends there.
      const Vec3i &a = surface_.triangles()[at(side)], &b = surface_.triangles()[at(p.triangle)];
      for (int k = 0; k < 3; ++k)
        if (a[k] == b[0] || a[k] == b[1] || a[k] == b[2]) add_end(x_[at(a[k])]);
    }
    return sum;
  }

  /// Adds pairs that do not cross but are closer than their thickness, behind a plane, or not yet far enough
  /// on the right side.
  void add_close() {
    candidates_.ignore_pairs(tangle_.crossing, model_.exempt);
    candidates_.apply_rules(rules_);
    candidates_.update(x_, x_, 0);
    for (const ContactPair& pair : candidates_.pairs()) {
      const int a = pieces_.of_point(pair.points[0]),
                b = pieces_.of_point(pair.points[at(first_feature_size(pair.kind))]);
      const bool sided = pair.kind != PairKind::point_plane && a != b && is_sided(a, b);
      if (has_lost_point(pair)) continue;
      const PairGeometry geometry = pair_geometry(surface_, pair, x_);
      Separation s;
      s.points = pair.points;
      s.weights = geometry.weights;
      s.normal = geometry.normal;
      double distance = geometry.distance;
      if (!(s.normal.norm() > 0)) s.normal = any_way_out(pair);
      bool facing = false;
      // Balls and capsules have no normals; they are left along the line.
      if (const Vec3 right = sided ? right_side(pair) : Vec3(Vec3::Zero()); right.norm() > 0) {
        // The line from an edge of a triangle or beside a ridge leads along the surface and tells no side.
        const double cosine = s.normal.dot(right.normalized());
        if (std::abs(cosine) < clear_cosine) continue;
        if (cosine < 0) {
          // Winding numbers have told which points are inside; farther features face each other across a
          // solid.
          const bool outside = pair.kind == PairKind::vertex_triangle && pieces_.is_solid(b);
          if (outside || distance > pair.thickness + pair.range) continue;
          s.normal = -s.normal;
          distance = -distance;
        }
        facing = cosine > facing_cosine;
      }
      const double least = sided ? pair.thickness + calm_share * pair.range : pair.thickness;
      s.gap = pair.thickness + gap_share * pair.range;
      s.stiffness = surface_.stiffness(pair.points[0], pair.points[at(first_feature_size(pair.kind))], dt_);
      if (sided ? distance < s.gap || facing : distance <= least) add(s);
      if (distance > least) continue;
      if (!sided) vote(pair, geometry);
      ++tangle_.close_count;
      tangle_.depth = std::max(tangle_.depth, pair.thickness - distance);
    }
    count_votes();
  }

  /// Notes on which sides of each other two pieces are that are too close but do not cross.
  void vote(const ContactPair& pair, const PairGeometry& geometry) {
    if (pair.kind != PairKind::vertex_triangle) return;
    const int of_point = pieces_.of_point(pair.first), of_triangle = pieces_.of_triangle(pair.second);
    if (of_point < 0 || of_point == of_triangle) return;
    const double cosine = geometry.normal.dot(normal(pair.second));
    Votes& votes = votes_[ordered(of_point, of_triangle)];
    (of_point < of_triangle ? votes.first : votes.second) += cosine;
    votes.aligned += std::abs(cosine);
    ++votes.count;
  }
  void count_votes() {
    for (const auto& [pair, votes] : votes_) {
      const bool solid = pieces_.is_solid(pair.first) || pieces_.is_solid(pair.second);
      const bool clear = votes.first != 0 && votes.second != 0 && votes.aligned > layered * votes.count;
      if (!solid && !clear) continue;
      if (!solid) {
        const auto behind = [](double side) { return side > 0 ? -1 : 1; };
        const Layering seen{true, behind(votes.first), behind(votes.second)};
        if (!layerings_.try_emplace(pair, seen).first->second.layers) continue;
      }
      sided_.insert(pair);
    }
  }

  /// Returns the right direction from the second feature of a sided pair to the first one.
  Vec3 right_side(const ContactPair& pair) const {
    const int a = pieces_.of_point(pair.points[0]),
              b = pieces_.of_point(pair.points[at(first_feature_size(pair.kind))]);
    const auto of = [&](std::span<const int> triangles, int other) {
      Vec3 sum = Vec3::Zero();
      for (const int t : triangles) sum += right_side(t, other);
      return sum;
    };
    Vec3 right = Vec3::Zero();
    if (pair.kind == PairKind::vertex_triangle) {
      right = right_side(pair.second, a);
      if (!(right.norm() > 0)) right = -of(surface_.triangles_at_point(pair.first), b);
    } else {
      right = of(surface_.triangles_at_edge(pair.second), a) - of(surface_.triangles_at_edge(pair.first), b);
    }
    return right;
  }

  /// True if a point of one feature is on the wrong side of the other's piece, and has its own separation.
  bool has_lost_point(const ContactPair& pair) const {
    const auto size = at(first_feature_size(pair.kind)), count = at(pair.point_count());
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = size; j < count; ++j) {
        const int a = pair.points[i], b = pair.points[j];
        const int lost_a = tangle_.free.free_of[at(a)], lost_b = tangle_.free.free_of[at(b)];
        if ((lost_a >= 0 && lost_a == pieces_.of_point(b)) || (lost_b >= 0 && lost_b == pieces_.of_point(a)))
          return true;
      }
    return false;
  }

  /// Flattens folds of a piece that cross where triangles have a common corner, or all that cross: their
  /// points move towards the middle of their neighbours.
  void add_folds(bool all) {
    std::set<int> folded;  // points
    for (const auto& [first, second] : tangle_.crossing) {
      if (pieces_.of_triangle(first) != pieces_.of_triangle(second)) continue;
      const Vec3i &a = surface_.triangles()[at(first)], &b = surface_.triangles()[at(second)];
      bool joined = false;
      for (const int i : a) joined = joined || i == b[0] || i == b[1] || i == b[2];
      if (!joined && !all) continue;
      folded.insert(a.begin(), a.end());
      folded.insert(b.begin(), b.end());
    }
    for (const int p : folded) {
      // Contact with other parts of the piece would keep the fold as it is.
      if (tangle_.free.free_of[at(p)] < 0) tangle_.free.free_of[at(p)] = pieces_.of_point(p);
      Vec3 sum = Vec3::Zero();
      int count = 0;
      for (const int t : surface_.triangles_at_point(p))
        for (const int n : surface_.triangles()[at(t)])
          if (n != p) sum += x_[at(n)], ++count;
      const Vec3 way = sum / count - x_[at(p)];
      if (!(way.norm() > 0)) continue;
      Separation s;
      s.points[0] = p;
      s.weights[0] = 1;
      s.normal = way.normalized();
      s.gap = s.normal.dot(sum) / count;
      s.stiffness = surface_.stiffness(p, p, dt_);
      add(s);
    }
  }

  /// Returns a direction for features that touch exactly: the normal of the triangle, or across both edges.
  Vec3 any_way_out(const ContactPair& pair) const {
    if (pair.kind == PairKind::vertex_triangle) {
      const Vec3 n = normal(pair.second);
      return n.norm() > 0 ? n : Vec3(0, 1, 0);
    }
    const auto along = [&](std::size_t i) {
      return Vec3(x_[at(pair.points[i + 1])] - x_[at(pair.points[i])]);
    };
    const Vec3 across = along(0).cross(along(2));
    return across.norm() > 0 ? Vec3(across.normalized()) : Vec3(0, 1, 0);
  }

  const ContactModel& model_;
  const ContactSurface& surface_;
  const SurfacePieces& pieces_;
  ContactCandidates& candidates_;
  Layerings& layerings_;
  std::set<std::pair<int, int>>& sided_;
  ContactRules::Set rules_;  // at the start
  double dt_, firmness_;
  std::vector<Vec3> x_;
  struct Votes {
    double first = 0, second = 0;  // of a piece: > 0 before the other one
    double aligned = 0, count = 0;
  };
  std::map<std::pair<int, int>, Votes> votes_;
  Tangle tangle_;
};

TangleFinder::TangleFinder(std::shared_ptr<const ContactModel> model)
    : model_(std::move(model)),
      pieces_(*model_->surface, model_->rest),
      candidates_(model_->surface, model_->rest, model_->distance) {}

Tangle TangleFinder::find(ConstVectors q, double dt, const Persistence& persistence) {
  return Search(*this, q, dt, persistence.firmness).find(persistence.flattens);
}

std::vector<WrongSide> find_wrong_sides(const std::shared_ptr<const ContactModel>& model, ConstVectors q) {
  TangleFinder finder(model);
  std::map<std::pair<int, int>, WrongSide> sides;
  for (const LostPoint& lost : finder.find(q, 1).wrong) {
    const int body = model->surface->body_of(lost.point), other = finder.pieces().body(lost.piece);
    WrongSide& side = sides.try_emplace({body, other}, WrongSide{body, other}).first->second;
    ++side.points;
    side.depth = std::max(side.depth, lost.depth);
  }
  std::vector<WrongSide> all;
  for (const auto& [bodies, side] : sides) all.push_back(side);
  return all;
}

std::string describe(const ContactModel& model, const WrongSide& side) {
  const auto name = [&](int body) { return model.names[at(body)]; };
  const bool solid = model.surface->bodies()[at(side.other)].solid;
  return fmt::format("{} point{} of \"{}\" {} {} \"{}\", up to {:.3g} mm deep", side.points,
                     side.points == 1 ? "" : "s", name(side.body), side.points == 1 ? "is" : "are",
                     solid ? "inside" : "on the wrong side of", name(side.other), 1e3 * side.depth);
}

}  // namespace muslin
