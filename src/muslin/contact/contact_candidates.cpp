#include "muslin/contact/contact_candidates.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 1024;

/// Of a rest distance, how much thickness and range together may take.
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
    default:
      return {first, surface.planes()[b].point, -1, -1};
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
    const Vec3& n = surface.planes()[static_cast<std::size_t>(pair.second)].normal;
    return {n, n.dot(at(0) - at(1)), {1, -1, 0, 0}};
  }
  const ClosestPoints c = pair.kind == PairKind::vertex_triangle
                              ? closest_vertex_triangle(at(0), at(1), at(2), at(3))
                              : closest_edge_edge(at(0), at(1), at(2), at(3));
  const double d = c.distance();
  return {d > 0 ? Vec3(c.difference / d) : Vec3(Vec3::Zero()), d, c.weights};
}

ContactCandidates::ContactCandidates(std::shared_ptr<const ContactSurface> surface, ConstVectors rest,
                                     double contact_distance)
    : surface_(std::move(surface)), contact_distance_(contact_distance), search_(surface_, rest) {
  if (!(contact_distance > 0))
    throw Error(ErrorKind::usage, "the contact distance is not positive", "give a length in metres");
  // What is close at rest within a body; boxes are widened by the radii already.
  const std::vector<int> sizes = points_of_bodies(*surface_);
  double thickest = 0;
  for (std::size_t body = 0; body < sizes.size(); ++body) {
    const ContactBody& b = surface_->bodies()[body];
    if (sizes[body] > 3 && b.self_contact && !b.fixed) thickest = std::max(thickest, 2 * b.radius);
  }
  search_.find(rest, rest, std::max(thickest, contact_distance / rest_range), found_);
  std::vector<ContactPair> pair;
  const auto note = [&](PairKind kind, int first, int second) {
    const std::array<int, 4> points = points_of(*surface_, kind, first, second);
    if (surface_->body_of(points[0]) != surface_->body_of(points[3])) return;
    pair.clear();
    add(kind, first, second, rest, pair);
    const double distance = pair_geometry(*surface_, pair.front(), rest).distance;
    if (rest_thickness * distance < pair.front().thickness || rest_range * distance < pair.front().range)
      rest_distances_.push_back({pair.front().key(), distance});
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

/// Adds the pair unless the plane across its closest points at `begin` keeps it out of range as long as all
/// points stay in their boxes.
void ContactCandidates::add(PairKind kind, int first, int second, ConstVectors begin,
                            std::vector<ContactPair>& out) const {
  ContactPair pair;
  pair.kind = kind;
  pair.first = first;
  pair.second = second;
  pair.points = points_of(*surface_, kind, first, second);
  const int count = pair.point_count();
  pair.thickness = surface_->radius_of(pair.points[0]) +
                   surface_->radius_of(pair.points[static_cast<std::size_t>(count - 1)]);
  pair.range = contact_distance_;
  limit_by_rest(pair);
  if (!lower_.empty()) {
    const PairGeometry at = pair_geometry(*surface_, pair, begin);
    const int size_a = first_feature_size(kind);
    double a = std::numeric_limits<double>::infinity(), b = -a;
    const Vec3 extent = at.normal.cwiseAbs();
    for (int i = 0; i < count; ++i) {
      const auto p = static_cast<std::size_t>(pair.points[static_cast<std::size_t>(i)]);
      const double middle = at.normal.dot(lower_[p] + upper_[p]) / 2;
      const double half = extent.dot(upper_[p] - lower_[p]) / 2;
      if (i < size_a) {
        a = std::min(a, middle - half);
      } else {
        b = std::max(b, middle + half);
      }
    }
    if (a - b > pair.thickness + pair.range) return;
  }
  out.push_back(pair);
}

void ContactCandidates::update(ConstVectors begin, ConstVectors end, double margin) {
  const std::size_t points = surface_->point_count();
  if (begin.size() != points || end.size() != points)
    throw Error(ErrorKind::usage, "contact candidates need one position for each point", "give #P positions");
  lower_.resize(points);
  upper_.resize(points);
  for (std::size_t p = 0; p < points; ++p) {
    lower_[p] = begin[p].cwiseMin(end[p]).array() - margin;
    upper_[p] = begin[p].cwiseMax(end[p]).array() + margin;
  }
  search_.find(lower_, upper_, contact_distance_, found_);
  const std::size_t vertex_triangle = found_.vertex_triangle.size(), edge_edge = found_.edge_edge.size();
  const std::size_t plane_pairs = surface_->planes().size() * points;
  const std::size_t total = vertex_triangle + edge_edge + plane_pairs;
  std::vector<std::vector<ContactPair>> parts((total + grain - 1) / grain);
  parallel_for(total, grain, [&](std::size_t from, std::size_t to) {
    std::vector<ContactPair>& out = parts[from / grain];
    for (std::size_t i = from; i < to; ++i) {
      if (i < vertex_triangle) {
        const VertexTriangle& p = found_.vertex_triangle[i];
        add(PairKind::vertex_triangle, p.point, p.triangle, begin, out);
      } else if (i < vertex_triangle + edge_edge) {
        const EdgeEdge& p = found_.edge_edge[i - vertex_triangle];
        add(PairKind::edge_edge, p.first, p.second, begin, out);
      } else {
        const std::size_t k = i - vertex_triangle - edge_edge;
        const int plane = static_cast<int>(k / points), point = static_cast<int>(k % points);
        const int carrier = surface_->planes()[static_cast<std::size_t>(plane)].point;
        if (point != carrier && surface_->may_touch(surface_->body_of(point), surface_->body_of(carrier)))
          add(PairKind::point_plane, point, plane, begin, out);
      }
    }
  });
  pairs_.clear();
  for (const std::vector<ContactPair>& part : parts) pairs_.insert(pairs_.end(), part.begin(), part.end());
}

double ContactCandidates::smallest_gap(ConstVectors x) const {
  struct Smallest {
    double gap = std::numeric_limits<double>::infinity();
    Smallest operator+(const Smallest& other) const { return {std::min(gap, other.gap)}; }
  };
  const double gap =
      parallel_sum(pairs_.size(), grain, Smallest{}, [&](std::size_t begin, std::size_t end) {
        Smallest s;
        for (std::size_t i = begin; i < end; ++i)
          s.gap = std::min(s.gap, pair_geometry(*surface_, pairs_[i], x).distance - pairs_[i].thickness);
        return s;
      }).gap;
  return gap <= contact_distance_ ? gap : std::numeric_limits<double>::infinity();
}

}  // namespace muslin
