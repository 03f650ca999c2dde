#include "muslin/contact/contact_potential.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "muslin/contact/conservative_advancement.hpp"
#include "muslin/contact/contact_energy.hpp"
#include "muslin/contact/contact_hessian.hpp"
#include "muslin/contact/turning_plane.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 512;
/// Pairs this many ranges apart are taken along: they may come into range in the iteration.
constexpr double ranges_ahead = PairDistances::ranges_known;
/// Edges fade out towards their ends over this share of the range, where the vertex there is in range as
/// well, but of no more than this share of their length; and below this squared sine of their angle.
constexpr double end_ranges = 0.5, end_share = 0.05, parallel_share = 1e-3;
/// What a triangle leaves to its neighbours ends where its corner opposite to them has this weight, so that
/// no more than two of its three edges are near.
constexpr double border_share = 0.3;

/// From 0 at 0 to 1 at 1 and beyond, smoothly.
double risen(double y) { return y >= 1 ? 1 : y <= 0 ? 0 : y * y * (3 - 2 * y); }

/// Of a vertex and a triangle: on an edge 1/n of its n triangles, at a corner the same of those there, and 1
/// away from them. Beside an edge the neighbours have their parts already, for their closest points lie on
/// it: what they push in the plane of this triangle is not counted again.
double triangle_share(const ContactSurface& surface, const ContactPair& pair, const PairGeometry& at,
                      ConstVectors x) {
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = x[static_cast<std::size_t>(pair.points[k + 1])];
  const double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  const Vec3i& edges = surface.triangle_edges()[static_cast<std::size_t>(pair.second)];
  const double depth = pair.range + pair.thickness - at.distance;
  // Edge k goes from corner k to the next. near[k] is the push of a neighbour there over this triangle's.
  std::array<double, 3> near{}, on_edge{1, 1, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    const int edge = edges[static_cast<Eigen::Index>(k)];
    const double weight = -at.weights[(k + 2) % 3 + 1];
    if (edge < 0 || weight >= border_share) continue;
    const double away = weight * area / std::max((corners[(k + 1) % 3] - corners[k]).norm(), 1e-300);
    const double farther = away * away / (at.distance + std::hypot(at.distance, away));
    near[k] = depth > farther ? (1 - farther / depth) * (1 - risen(2 * weight / border_share - 1)) : 0;
    if (weight <= 0) near[k] = 1;
    on_edge[k] = 1.0 / surface.triangles_at_edge(edge);
  }
  double share = (1 - near[0]) * (1 - near[1]) * (1 - near[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
    share += near[k] * (1 - near[next]) * (1 - near[last]) * on_edge[k];
    share += near[k] * near[last] * (1 - near[next]) / surface.triangles_at_point(pair.points[k + 1]);
  }
  return share;
}

/// Of two edges.
double edge_share(const ContactPair& pair, const PairGeometry& at, ConstVectors x) {
  const auto along = [&](std::size_t i) {
    return Vec3(x[static_cast<std::size_t>(pair.points[i + 1])] -
                x[static_cast<std::size_t>(pair.points[i])]);
  };
  const Vec3 u = along(0), v = along(2);
  const double sine = u.cross(v).squaredNorm() / std::max(u.squaredNorm() * v.squaredNorm(), 1e-300);
  const double apart = std::min(1.0, sine / parallel_share);
  const auto inside = [&](double t, double squared_length) {
    const double width =
        std::min(end_share, end_ranges * pair.range / std::sqrt(std::max(squared_length, 1e-300)));
    return risen(std::min(t, 1 - t) / width);
  };
  return inside(at.weights[1], u.squaredNorm()) * inside(-at.weights[3], v.squaredNorm()) * apart *
         (2 - apart);
}

/// The share of a pair in the contact at its closest points: continuous, because where a force jumps there
/// may be no balance to find.
double contact_share(const ContactSurface& surface, const ContactPair& pair, const PairGeometry& at,
                     ConstVectors x) {
  switch (pair.kind) {
    case PairKind::point_plane:
      break;
    case PairKind::vertex_triangle:
      return triangle_share(surface, pair, at, x);
    case PairKind::edge_edge:
      return edge_share(pair, at, x);
  }
  return 1;
}

Vec3 combined(const ContactPair& pair, const std::array<double, 4>& weights, ConstVectors x) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < pair.point_count(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    sum += weights[k] * x[static_cast<std::size_t>(pair.points[k])];
  }
  return sum;
}

/// Place of a point of the second feature.
std::size_t last_point(const ContactPair& pair) { return static_cast<std::size_t>(pair.point_count() - 1); }

Vec3 tangential(const Vec3& v, const Vec3& normal) { return v - normal.dot(v) * normal; }

}  // namespace

ContactPotential::ContactPotential(const PairDistances& distances, std::shared_ptr<const SurfaceMap> map,
                                   ConstVectors lagged, Friction friction, ConstVectors start,
                                   std::span<const PairSlip> slips)
    : surface_(distances.candidates().shared_surface()),
      map_(std::move(map)),
      friction_(friction),
      lagged_(distances.points().begin(), distances.points().end()) {
  if (!(friction.coefficient >= 0) || !(friction.stick_length > 0))
    throw Error(ErrorKind::usage, "a friction coefficient is negative",
                "give 0 or more, and a stick length above 0");
  if (lagged.size() != map_->vertex_count() || start.size() != lagged.size() ||
      distances.points().size() != map_->point_count())
    throw Error(ErrorKind::usage, "a contact potential needs one position for each vertex",
                "give #V positions");
  std::vector<Vec3> start_buffer;
  const ConstVectors x = distances.points(), x_start = points(start, start_buffer);
  const std::span<const ContactPair> all = distances.candidates().pairs();
  std::vector<std::vector<Pair>> parts((all.size() + grain - 1) / grain);
  std::vector<std::vector<Carried>> carried_parts(parts.size());
  parallel_for(all.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!distances.is_known(i)) continue;
      const PairGeometry& at = distances[i];
      const double gap = at.distance - all[i].thickness;
      if (gap >= ranges_ahead * all[i].range || !(gap > 0)) continue;
      const double share = contact_share(*surface_, all[i], at, x);
      if (share <= 0) continue;
      Pair pair;
      pair.pair = all[i];
      pair.stiffness = surface_->stiffness(all[i].points[0], all[i].points[last_point(all[i])]) * share;
      pair.lagged = at;
      pair.normal = at.normal;
      pair.weights = at.weights;
      pair.begin.setZero();
      const double coefficient =
          surface_->friction(all[i].points[0], all[i].points[last_point(all[i])], friction.coefficient);
      if (coefficient > 0 && gap < all[i].range) {
        pair.friction = -coefficient * pair.stiffness * contact_law(gap, all[i].range).slope;
        Carried carried;
        carry(pair, at, x, lagged, carried);
        pair.begin = combined(all[i], pair.weights, x_start);
        for (const SurfaceMap::Entry& e : carried.span())
          pair.begin += e.weight * start[static_cast<std::size_t>(e.vertex)];
        if (carried.count > 0) {
          pair.carried = static_cast<int>(carried_parts[begin / grain].size());
          carried_parts[begin / grain].push_back(carried);
        }
        const std::uint64_t key = all[i].key();
        const auto known = std::lower_bound(slips.begin(), slips.end(), key,
                                            [](const PairSlip& s, std::uint64_t k) { return s.key < k; });
        if (known != slips.end() && known->key == key) pair.begin -= tangential(known->slip, at.normal);
      }
      parts[begin / grain].push_back(pair);
    }
  });
  for (std::size_t b = 0; b < parts.size(); ++b) {
    for (Pair& pair : parts[b]) {
      if (pair.carried >= 0) pair.carried += static_cast<int>(carried_.size());
    }
    pairs_.insert(pairs_.end(), parts[b].begin(), parts[b].end());
    carried_.insert(carried_.end(), carried_parts[b].begin(), carried_parts[b].end());
  }

  offsets_.assign(surface_->point_count() + 1, 0);
  for (const Pair& pair : pairs_)
    for (int k = 0; k < pair.pair.point_count(); ++k)
      ++offsets_[static_cast<std::size_t>(pair.pair.points[static_cast<std::size_t>(k)]) + 1];
  for (std::size_t p = 0; p + 1 < offsets_.size(); ++p) offsets_[p + 1] += offsets_[p];
  places_.resize(static_cast<std::size_t>(offsets_.back()));
  std::vector<int> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    for (int k = 0; k < pairs_[i].pair.point_count(); ++k) {
      int& at = next[static_cast<std::size_t>(pairs_[i].pair.points[static_cast<std::size_t>(k)])];
      places_[static_cast<std::size_t>(at++)] = static_cast<int>(4 * i) + k;
    }
  }
}

class ContactPotential::Geometries {
 public:
  Geometries(const ContactPotential& w, ConstVectors x)
      : surface_(*w.surface_), x_(x), lagged_(std::equal(x.begin(), x.end(), w.lagged_.begin())) {}
  PairGeometry operator()(const Pair& pair) const {
    return lagged_ ? pair.lagged : pair_geometry(surface_, pair.pair, x_);
  }

 private:
  const ContactSurface& surface_;
  ConstVectors x_;
  bool lagged_;
};

ConstVectors ContactPotential::points(ConstVectors q, std::vector<Vec3>& buffer) const {
  if (map_->is_identity()) return q;
  buffer.resize(map_->point_count());
  map_->apply(q, buffer);
  return buffer;
}

/// Where a feature belongs to a body with a frame: the point of its surface that touches, by the frame's
/// vertices; its points no longer count.
void ContactPotential::carry(Pair& pair, const PairGeometry& at, ConstVectors x, ConstVectors q,
                             Carried& carried) const {
  const int count = pair.pair.point_count(), size_a = first_feature_size(pair.pair.kind);
  for (const bool first : {true, false}) {
    const int from = first ? 0 : size_a, to = first ? size_a : count;
    const ContactBody& body = surface_->body_at(pair.pair.points[static_cast<std::size_t>(from)]);
    if (body.frame[0] < 0) continue;
    const double sign = first ? 1 : -1;
    Vec3 point = Vec3::Zero();
    for (int i = from; i < to; ++i) {
      const auto k = static_cast<std::size_t>(i);
      point += sign * at.weights[k] * x[static_cast<std::size_t>(pair.pair.points[k])];
    }
    point -= sign * body.radius * at.normal;
    const auto corner = [&](std::size_t k) -> const Vec3& {
      return q[static_cast<std::size_t>(body.frame[k])];
    };
    Mat3 edges;
    for (std::size_t k = 1; k < 4; ++k) edges.col(static_cast<Eigen::Index>(k) - 1) = corner(k) - corner(0);
    const Vec3 share = edges.inverse() * (point - corner(0));
    if (!share.allFinite()) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const double weight = k == 0 ? 1 - share.sum() : share[static_cast<Eigen::Index>(k) - 1];
      carried.entries[carried.count++] = {body.frame[k], sign * weight};
    }
    for (int i = from; i < to; ++i) pair.weights[static_cast<std::size_t>(i)] = 0;
  }
}

std::span<const SurfaceMap::Entry> ContactPotential::carried(const Pair& pair) const {
  if (pair.carried < 0) return {};
  return carried_[static_cast<std::size_t>(pair.carried)].span();
}

Vec3 ContactPotential::relative(const Pair& pair, ConstVectors x, ConstVectors q) const {
  Vec3 sum = combined(pair.pair, pair.weights, x);
  for (const SurfaceMap::Entry& e : carried(pair)) sum += e.weight * q[static_cast<std::size_t>(e.vertex)];
  return sum;
}

Vec3 ContactPotential::slip(const Pair& pair, ConstVectors x, ConstVectors q) const {
  return tangential(relative(pair, x, q) - pair.begin, pair.normal);
}

ContactPotential::Parts ContactPotential::parts(ConstVectors q) const {
  std::vector<Vec3> buffer;
  const ConstVectors x = points(q, buffer);
  const Geometries geometry(*this, x);
  return parallel_sum(pairs_.size(), grain, Parts{}, [&](std::size_t begin, std::size_t end) {
    Parts sum;
    for (std::size_t i = begin; i < end; ++i) {
      const Pair& pair = pairs_[i];
      const double gap = geometry(pair).distance - pair.pair.thickness;
      sum.pressed += pair.stiffness * contact_law(gap, pair.pair.range).value;
      if (pair.friction > 0)
        sum.rubbed += pair.friction * friction_law(slip(pair, x, q).norm(), friction_.stick_length).value;
    }
    return sum;
  });
}

double ContactPotential::value(ConstVectors q) const {
  const Parts both = parts(q);
  return both.pressed + both.rubbed;
}

void ContactPotential::add_gradient(ConstVectors q, Vectors g) const {
  std::vector<Vec3> buffer;
  const ConstVectors x = points(q, buffer);
  const Geometries geometry(*this, x);
  std::vector<Vec3> forces(4 * pairs_.size()), rubs(carried_.size());
  parallel_for(pairs_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Pair& pair = pairs_[i];
      const PairGeometry at = geometry(pair);
      const double slope =
          pair.stiffness * contact_law(at.distance - pair.pair.thickness, pair.pair.range).slope;
      Vec3 rub = Vec3::Zero();
      if (pair.friction > 0) {
        const Vec3 e = slip(pair, x, q);
        rub = pair.friction * friction_law(e.norm(), friction_.stick_length).curvature * e;
      }
      if (pair.carried >= 0) rubs[static_cast<std::size_t>(pair.carried)] = rub;
      for (std::size_t k = 0; k < 4; ++k)
        forces[4 * i + k] = at.weights[k] * slope * at.normal + pair.weights[k] * rub;
    }
  });
  // Each point adds up its pairs in their order.
  std::vector<Vec3> sums;
  const bool direct = map_->is_identity();
  if (!direct) sums.assign(map_->point_count(), Vec3::Zero());
  const Vectors target = direct ? g : Vectors(sums);
  parallel_for(map_->point_count(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (int k = offsets_[p]; k < offsets_[p + 1]; ++k)
        target[p] += forces[static_cast<std::size_t>(places_[static_cast<std::size_t>(k)])];
  });
  if (!direct) map_->add_transpose(sums, g);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    for (const SurfaceMap::Entry& e : carried(pairs_[i]))
      g[static_cast<std::size_t>(e.vertex)] += e.weight * rubs[static_cast<std::size_t>(pairs_[i].carried)];
  }
}

/// The Hessian at one q.
class ContactPotential::Hessian : public ContactHessian {
 public:
  Hessian(const ContactPotential& w, ConstVectors q) : ContactHessian(*w.map_, rows(w, q)) {}

 private:
  static std::vector<ContactRow> rows(const ContactPotential& w, ConstVectors q) {
    std::vector<Vec3> buffer;
    const ConstVectors x = w.points(q, buffer);
    const Geometries geometry(w, x);
    const std::size_t count = w.pairs_.size();
    std::vector<ContactRow> all(2 * count);  // normal and friction of each pair
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Pair& pair = w.pairs_[i];
        const PairGeometry at = geometry(pair);
        const double curvature =
            pair.stiffness * contact_law(at.distance - pair.pair.thickness, pair.pair.range).curvature;
        all[2 * i] = {pair.pair.points, at.weights, at.normal, curvature, 0, {}};
        all[2 * i + 1] = {pair.pair.points, pair.weights, pair.normal, 0, 0, w.carried(pair)};
        if (pair.friction <= 0) continue;
        const double secant =
            pair.friction * friction_law(w.slip(pair, x, q).norm(), w.friction_.stick_length).curvature;
        // One row is enough where nothing has moved since friction was lagged.
        all[2 * i + (at.weights == pair.weights && pair.carried < 0 ? 0 : 1)].tangential = secant;
      }
    });
    std::erase_if(all,
                  [](const ContactRow& row) { return row.normal_stiffness == 0 && row.tangential == 0; });
    return all;
  }
};

void ContactPotential::add_hessian_product(ConstVectors q, ConstVectors p, Vectors y) const {
  Hessian(*this, q).add_hessian_product(q, p, y);
}

void ContactPotential::add_diagonal_blocks(ConstVectors q, std::span<Mat3> blocks) const {
  Hessian(*this, q).add_diagonal_blocks(q, blocks);
}

void ContactPotential::linearize(ConstVectors q, Linearization& into, std::size_t first) const {
  Hessian(*this, q).linearize(q, into, first);
}

double ContactPotential::max_step(ConstVectors q, ConstVectors d) const {
  std::vector<Vec3> buffer, step_buffer;
  const ConstVectors x = points(q, buffer), u = points(d, step_buffer);
  struct Smallest {
    double value = std::numeric_limits<double>::infinity();
    Smallest operator+(const Smallest& other) const { return {std::min(value, other.value)}; }
  };
  return parallel_sum(pairs_.size(), grain, Smallest{},
                      [&](std::size_t begin, std::size_t end) {
                        Smallest smallest;
                        for (std::size_t i = begin; i < end; ++i) {
                          const ContactPair& pair = pairs_[i].pair;
                          const PairGeometry at = pair_geometry(*surface_, pair, x);
                          const double gap = at.distance - pair.thickness,
                                       required = pair.thickness + 0.1 * gap;
                          double factor = 1;
                          if (pair.point_count() == 2) {
                            const double approach = -at.normal.dot(combined(pair, at.weights, u));
                            if (approach > 0.9 * gap) factor = 0.9 * gap / approach;
                          } else {
                            std::array<Vec3, 4> from, by;
                            for (std::size_t k = 0; k < 4; ++k) {
                              from[k] = x[static_cast<std::size_t>(pair.points[k])];
                              by[k] = u[static_cast<std::size_t>(pair.points[k])];
                            }
                            factor = pair.kind == PairKind::point_plane
                                         ? safe_fraction_over_plane(from, by, required)
                                         : safe_fraction(pair.kind, from, by, required, 0.01 * gap);
                          }
                          if (factor < 1) smallest.value = std::min(smallest.value, factor);
                        }
                        return smallest;
                      })
      .value;
}

std::vector<PairSlip> ContactPotential::slips(ConstVectors q) const {
  std::vector<Vec3> buffer;
  const ConstVectors x = points(q, buffer);
  std::vector<PairSlip> result;
  for (const Pair& pair : pairs_) {
    if (pair.friction <= 0) continue;
    Vec3 e = slip(pair, x, q);
    const double length = e.norm();
    if (length > friction_.stick_length) e *= friction_.stick_length / length;
    result.push_back({pair.pair.key(), e});
  }
  std::sort(result.begin(), result.end(), [](const PairSlip& a, const PairSlip& b) { return a.key < b.key; });
  return result;
}

}  // namespace muslin
