#include "muslin/untangle/tangle.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

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
/// Contours become shorter in steps of this share of an edge.
constexpr double edge_share = 0.25;
/// Points on a wrong side come back by this many edges in a step.
constexpr double edges_at_once = 0.5;
/// Least sine between an edge and the triangle that it pierces, in the direction of shortening.
constexpr double least_sine = 0.1;
constexpr double perturbation = 1e-9;  // over the size of the surface

}  // namespace

class TangleFinder::Search {
 public:
  Search(TangleFinder& finder, ConstVectors q, double dt)
      : model_(*finder.model_), surface_(*model_.surface), pieces_(finder.pieces_),
        candidates_(finder.candidates_), decided_(finder.decided_), dt_(dt), x_(surface_.point_count()) {
    model_.map->apply(q, x_);
  }

  Tangle find() {
    tangle_.lost.assign(surface_.point_count(), -1);
    find_crossing();
    perturb();
    const std::vector<Piercing> piercings = find_piercings(surface_, x_, tangle_.crossing);
    add_lost(find_solid_insides(surface_, pieces_, x_, tangle_.crossing));
    add_lost(find_crossed_regions(surface_, pieces_, x_, piercings, decided_));
    add_piercings(piercings);
    add_close();
    return std::move(tangle_);
  }

 private:
  void find_crossing() {
    const auto body_of = [&](int t) { return surface_.body_of(surface_.triangles()[at(t)][0]); };
    IntersectionOptions options;
    options.wanted = [&](int a, int b) {
      return surface_.may_touch(body_of(a), body_of(b)) &&
             !model_.exempt.has(surface_.triangles()[at(a)], a, surface_.triangles()[at(b)], b);
    };
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

  double gap(int point, int other) const {
    return surface_.radius_of(point) + surface_.radius_of(other) + gap_share * model_.distance;
  }

  /// Adds that point `p` or the place on edge `e` has to pass the place on a triangle by `gap`.
  void add(const Separation& s) {
    if (s.normal.allFinite() && std::isfinite(s.stiffness)) tangle_.separations.push_back(s);
  }

  void add_lost(std::span<const LostPoint> all) {
    std::map<int, int> count;  // by triangle
    for (const LostPoint& lost : all) ++count[lost.triangle];
    for (const LostPoint& lost : all) {
      if (tangle_.lost[at(lost.point)] >= 0) continue;
      tangle_.lost[at(lost.point)] = lost.piece;
      ++tangle_.lost_count;
      tangle_.depth = std::max(tangle_.depth, lost.depth);
      const Vec3i& t = surface_.triangles()[at(lost.triangle)];
      Separation s;
      s.points = {lost.point, t[0], t[1], t[2]};
      s.weights = {1, -lost.barycentric[0], -lost.barycentric[1], -lost.barycentric[2]};
      s.normal = lost.out;
      const double edge = (x_[at(t[1])] - x_[at(t[0])]).norm();
      s.gap = std::min(gap(lost.point, t[0]), edges_at_once * edge - lost.depth);
      // All points together press a triangle like one contact.
      s.stiffness = surface_.stiffness(lost.point, t[0], dt_) / count.at(lost.triangle);
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
      const auto is_lost = [&](int point, int piece) { return tangle_.lost[at(point)] == piece; };
      if (is_lost(e[0], of_triangle) || is_lost(e[1], of_triangle) || is_lost(t[0], of_edge) ||
          is_lost(t[1], of_edge) || is_lost(t[2], of_edge))
        continue;
      Vec3 way;  // of the edge over the triangle
      double length = gap(e[0], t[0]);
      if (pieces_.is_solid(of_triangle)) {
        way = normal(p.triangle);
      } else if (pieces_.is_solid(of_edge)) {
        way = Vec3::Zero();
        for (const int side : surface_.triangles_at_edge(p.edge)) way -= normal(side);
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
  /// triangles. With E along the edge and N normal to the triangle, a motion D of the edge moves the corner by
  /// D − (D·N)/(E·N) E, and the contour shortens most for D = Σ (R − (E·R)/(E·N) N).
  Vec3 shortening(std::span<const Piercing> all, std::size_t i,
                  const std::map<std::pair<int, int>, std::vector<int>>& contours) const {
    const Piercing& p = all[i];
    const ContactSurface::Edge& edge = surface_.edges()[at(p.edge)];
    const Vec3 e = (x_[at(edge[1])] - x_[at(edge[0])]).normalized(), n = normal(p.triangle);
    double sine = e.dot(n);
    if (std::abs(sine) < least_sine) sine = sine < 0 ? -least_sine : least_sine;
    Vec3 sum = Vec3::Zero();
    for (const int side : surface_.triangles_at_edge(p.edge)) {
      for (const int other : contours.at(std::minmax(side, p.triangle))) {
        if (other == static_cast<int>(i)) continue;
        const Vec3 along = all[at(other)].at - p.at;
        if (!(along.norm() > 0)) continue;
        const Vec3 r = along.normalized();
        sum += r - e.dot(r) / sine * n;
      }
    }
    return sum;
  }

  /// Adds pairs that do not cross but are closer than their thickness, or behind a plane.
  void add_close() {
    candidates_.ignore_pairs(tangle_.crossing, model_.exempt);
    candidates_.update(x_, x_, 0);
    for (const ContactPair& pair : candidates_.pairs()) {
      if (is_apart(pair)) continue;
      const PairGeometry geometry = pair_geometry(surface_, pair, x_);
      if (geometry.distance > pair.thickness) continue;
      ++tangle_.close_count;
      Separation s;
      s.points = pair.points;
      s.weights = geometry.weights;
      s.normal = geometry.normal;
      if (!(s.normal.norm() > 0)) s.normal = any_way_out(pair);
      s.gap = pair.thickness + gap_share * pair.range;
      s.stiffness = surface_.stiffness(pair.points[0], pair.points[at(first_feature_size(pair.kind))], dt_);
      if (pair.kind != PairKind::vertex_triangle || pair.thickness > geometry.distance)
        tangle_.depth = std::max(tangle_.depth, pair.thickness - geometry.distance);
      add(s);
    }
  }

  /// True if a point of one feature is on the wrong side of the other's piece: the pair's own direction would
  /// push it further.
  bool is_apart(const ContactPair& pair) const {
    const auto size = at(first_feature_size(pair.kind)), count = at(pair.point_count());
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = size; j < count; ++j) {
        const int a = pair.points[i], b = pair.points[j];
        const int lost_a = tangle_.lost[at(a)], lost_b = tangle_.lost[at(b)];
        if ((lost_a >= 0 && lost_a == pieces_.of_point(b)) || (lost_b >= 0 && lost_b == pieces_.of_point(a)))
          return true;
      }
    return false;
  }

  /// Returns a direction for features that touch exactly: the normal of the triangle, or across both edges.
  Vec3 any_way_out(const ContactPair& pair) const {
    if (pair.kind == PairKind::vertex_triangle) {
      const Vec3 n = normal(pair.second);
      return n.allFinite() ? n : Vec3(0, 1, 0);
    }
    const auto along = [&](std::size_t i) { return Vec3(x_[at(pair.points[i + 1])] - x_[at(pair.points[i])]); };
    const Vec3 across = along(0).cross(along(2));
    return across.norm() > 0 ? Vec3(across.normalized()) : Vec3(0, 1, 0);
  }

  const ContactModel& model_;
  const ContactSurface& surface_;
  const SurfacePieces& pieces_;
  ContactCandidates& candidates_;
  std::map<std::pair<int, int>, int>& decided_;
  double dt_;
  std::vector<Vec3> x_;
  Tangle tangle_;
};

TangleFinder::TangleFinder(std::shared_ptr<const ContactModel> model)
    : model_(std::move(model)),
      pieces_(*model_->surface, model_->rest),
      candidates_(model_->surface, model_->rest, model_->distance) {}

Tangle TangleFinder::find(ConstVectors q, double dt) { return Search(*this, q, dt).find(); }

}  // namespace muslin
