#include "muslin/contact/contact_potential.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "muslin/contact/contact_energy.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t potential_grain = 512;

int point_count(const MergedContact& contact) {
  int count = 0;
  while (count < 4 && contact.points[static_cast<std::size_t>(count)] >= 0) ++count;
  return count;
}

Vec3 combined(const MergedContact& contact, const std::array<double, 4>& weights, ConstVectors x) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 4 && contact.points[k] >= 0; ++k)
    sum += weights[k] * x[static_cast<std::size_t>(contact.points[k])];
  return sum;
}

Vec3 tangential(const Vec3& v, const Vec3& normal) { return v - normal.dot(v) * normal; }

double coefficient_of(const ContactSurface& surface, const MergedContact& contact, const Friction& friction) {
  if (contact.rule >= 0)
    if (const std::optional<KeyedNumber>& ruled = surface.rules()[contact.rule].friction)
      return ruled->at(friction.time);
  const auto side = [&](int begin, int end) {
    const auto first = static_cast<std::size_t>(begin), size = static_cast<std::size_t>(end - begin);
    return ContactSurface::Side{std::span(contact.points).subspan(first, size),
                                std::span(contact.weights).subspan(first, size)};
  };
  return surface.friction(side(0, contact.first_size), side(contact.first_size, point_count(contact)),
                          friction.coefficient, friction.time);
}

constexpr std::uint64_t second_mask = (std::uint64_t{1} << 31) - 1;

/// Returns the slip with which a contact continues: the slip of its pair; for a vertex that has moved on to a
/// neighbouring triangle, the slip on the last one; otherwise zero.
Vec3 known_slip(const ContactSurface& surface, std::uint64_t key, std::span<const PairSlip> slips) {
  const auto by_key = [](const PairSlip& s, std::uint64_t k) { return s.key < k; };
  const auto known = std::lower_bound(slips.begin(), slips.end(), key, by_key);
  if (known != slips.end() && known->key == key) return known->slip;
  if (key >> 62 != static_cast<std::uint64_t>(PairKind::vertex_triangle)) return Vec3::Zero();
  const std::uint64_t first = key & ~second_mask;
  const Vec3i& triangle = surface.triangles()[key & second_mask];
  for (auto s = std::lower_bound(slips.begin(), slips.end(), first, by_key);
       s != slips.end() && (s->key & ~second_mask) == first; ++s) {
    const Vec3i& last = surface.triangles()[s->key & second_mask];
    for (int i = 0; i < 3; ++i)
      if (last[i] == triangle[0] || last[i] == triangle[1] || last[i] == triangle[2]) return s->slip;
  }
  return Vec3::Zero();
}

}  // namespace

ContactPotential::ContactPotential(const PairDistances& distances, std::shared_ptr<const SurfaceMap> map,
                                   ConstVectors lagged, Friction friction)
    : surface_(distances.candidates().shared_surface()),
      map_(std::move(map)),
      friction_(friction),
      lagged_q_(lagged.begin(), lagged.end()),
      lagged_(distances.points().begin(), distances.points().end()) {
  if (!(friction.coefficient >= 0) || !(friction.stick_length > 0))
    throw Error(ErrorKind::usage, "a friction coefficient is negative",
                "give 0 or more, and a stick length above 0");
  if (lagged.size() != map_->vertex_count() || distances.points().size() != map_->point_count())
    throw Error(ErrorKind::usage, "a contact potential needs one position for each vertex",
                "give #V positions");
  terms_ = contact_terms(distances, friction.dt);
  contacts_ = merged_contacts(*surface_, terms_, lagged_);
}

ContactPotential::ContactPotential(const PairDistances& distances, std::shared_ptr<const SurfaceMap> map,
                                   ConstVectors lagged, const ContactPotential& friction,
                                   SlidingStiffness sliding)
    : ContactPotential(distances, std::move(map), lagged, friction.friction_) {
  sliding_ = sliding;
  friction_terms_ = friction.friction_terms_;
  carried_ = friction.carried_;
}

ContactPotential::ContactPotential(const PairDistances& distances, std::shared_ptr<const SurfaceMap> map,
                                   ConstVectors lagged, Friction friction, ConstVectors start,
                                   std::span<const PairSlip> slips)
    : ContactPotential(distances, std::move(map), lagged, friction) {
  if (start.size() != lagged.size())
    throw Error(ErrorKind::usage, "a contact potential needs one position for each vertex",
                "give #V positions");
  std::vector<Vec3> start_buffer;
  const ConstVectors x_start = points(start, start_buffer);
  struct Made {
    FrictionTerm sliding;
    Carried carried;
  };
  const auto made = parallel_collect<Made>(
      contacts_.size(), potential_grain, [&](std::size_t begin, std::size_t end, auto& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const MergedContact& contact = contacts_[i];
          if (!(contact.slope < 0) || contact.key == 0) continue;
          const double coefficient = coefficient_of(*surface_, contact, friction);
          if (!(coefficient > 0)) continue;
          Made& one = out.emplace_back();
          FrictionTerm& sliding = one.sliding;
          sliding.contact = contact;
          sliding.limit = -coefficient * contact.slope;
          sliding.weights = contact.weights;
          carry(sliding, lagged_, lagged, one.carried);
          sliding.begin = combined(contact, sliding.weights, x_start);
          for (const SurfaceMap::Entry& e : one.carried.span())
            sliding.begin += e.weight * start[static_cast<std::size_t>(e.vertex)];
          sliding.begin -= tangential(known_slip(*surface_, contact.key, slips), contact.normal);
        }
      });
  friction_terms_.reserve(made.size());
  for (const Made& one : made) {
    FrictionTerm& sliding = friction_terms_.emplace_back(one.sliding);
    if (one.carried.count == 0) continue;
    sliding.carried = static_cast<int>(carried_.size());
    carried_.push_back(one.carried);
  }
}

ConstVectors ContactPotential::points(ConstVectors q, std::vector<Vec3>& buffer) const {
  if (map_->is_identity()) return q;
  buffer.resize(map_->point_count());
  map_->apply(q, buffer);
  return buffer;
}

std::span<const MergedContact> ContactPotential::contacts(ConstVectors x,
                                                          std::vector<MergedContact>& buffer) const {
  if (std::equal(x.begin(), x.end(), lagged_.begin())) return contacts_;
  buffer = merged_contacts(*surface_, terms_, x);
  return buffer;
}

/// If a feature belongs to a body with a frame, expresses the touching point of its surface by the frame's
/// vertices, which replace the points of the feature.
void ContactPotential::carry(FrictionTerm& sliding, ConstVectors x, ConstVectors q, Carried& carried) const {
  const MergedContact& at = sliding.contact;
  const int count = point_count(at);
  for (const bool first : {true, false}) {
    const int from = first ? 0 : at.first_size, to = first ? at.first_size : count;
    const ContactBody& body = surface_->body_at(at.points[static_cast<std::size_t>(from)]);
    if (body.frame[0] < 0) continue;
    const double sign = first ? 1 : -1;
    Vec3 point = Vec3::Zero();
    for (int i = from; i < to; ++i) {
      const auto k = static_cast<std::size_t>(i);
      point += sign * at.weights[k] * x[static_cast<std::size_t>(at.points[k])];
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
    for (int i = from; i < to; ++i) sliding.weights[static_cast<std::size_t>(i)] = 0;
  }
}

std::span<const SurfaceMap::Entry> ContactPotential::carried(const FrictionTerm& sliding) const {
  if (sliding.carried < 0) return {};
  return carried_[static_cast<std::size_t>(sliding.carried)].span();
}

Vec3 ContactPotential::slip(const FrictionTerm& sliding, ConstVectors x, ConstVectors q) const {
  Vec3 sum = combined(sliding.contact, sliding.weights, x);
  for (const SurfaceMap::Entry& e : carried(sliding)) sum += e.weight * q[static_cast<std::size_t>(e.vertex)];
  return tangential(sum - sliding.begin, sliding.contact.normal);
}

ContactPotential::Parts ContactPotential::parts(ConstVectors q) const {
  std::vector<Vec3> buffer;
  const ConstVectors x = points(q, buffer);
  Parts sum;
  sum.normal = parallel_sum(terms_.size(), potential_grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const ContactTerm& term = terms_[i];
      const double gap = term_geometry(*surface_, term, x).distance - term.thickness;
      if (gap < term.range) part += term.stiffness * contact_law(gap, term.range).value;
    }
    return part;
  });
  sum.friction =
      parallel_sum(friction_terms_.size(), potential_grain, 0.0, [&](std::size_t begin, std::size_t end) {
        double part = 0;
        for (std::size_t i = begin; i < end; ++i)
          part += friction_terms_[i].limit *
                  friction_law(slip(friction_terms_[i], x, q).norm(), friction_.stick_length).value;
        return part;
      });
  return sum;
}

double ContactPotential::value(ConstVectors q) const {
  const Parts both = parts(q);
  return both.normal + both.friction;
}

void ContactPotential::add_gradient(ConstVectors q, Vectors g) const {
  std::vector<Vec3> buffer, sums;
  std::vector<MergedContact> merged;
  const ConstVectors x = points(q, buffer);
  const bool direct = map_->is_identity();
  if (!direct) sums.assign(map_->point_count(), Vec3::Zero());
  const Vectors target = direct ? g : Vectors(sums);
  const auto push = [&](const MergedContact& contact, const std::array<double, 4>& weights, const Vec3& by) {
    for (std::size_t k = 0; k < 4 && contact.points[k] >= 0; ++k)
      target[static_cast<std::size_t>(contact.points[k])] += weights[k] * by;
  };
  for (const MergedContact& contact : contacts(x, merged))
    push(contact, contact.weights, contact.slope * contact.normal);
  for (const FrictionTerm& sliding : friction_terms_) {
    const Vec3 e = slip(sliding, x, q);
    const Vec3 force = sliding.limit * friction_law(e.norm(), friction_.stick_length).curvature * e;
    push(sliding.contact, sliding.weights, force);
    for (const SurfaceMap::Entry& entry : carried(sliding))
      g[static_cast<std::size_t>(entry.vertex)] += entry.weight * force;
  }
  if (!direct) map_->add_transpose(sums, g);
}

/// A triangle that tilts about its point nearest to the centre of a sphere comes closer to it, by half the
/// distance times the square of the angle: positive curvature of the energy where it is pushed away,
///
///   −b′ d pᵀ G⁻¹ p,   p = (n·δu, n·δv),   G the Gram matrix of the triangle's edges u, v.
void ContactPotential::add_tilt(const MergedContact& contact, ConstVectors x,
                                std::vector<ContactRow>& rows) const {
  if (contact.points[3] < 0 || contact.first_size != 1 || !(contact.slope < 0) ||
      !surface_->is_round(contact.points[0]))
    return;
  const auto corner = [&](std::size_t k) -> const Vec3& {
    return x[static_cast<std::size_t>(contact.points[k])];
  };
  const Vec3 u = corner(2) - corner(1), v = corner(3) - corner(1);
  const double uu = u.squaredNorm(), along = u.dot(v) / uu, vv = v.squaredNorm() - along * along * uu;
  const double stiffness = -contact.slope * contact.distance;
  // pᵀ G⁻¹ p = (n·δu)² / |u|² + (n·δ(v − along u))² / |v − along u|².
  const double a = 1 / std::sqrt(uu), b = 1 / std::sqrt(vv);
  if (!(vv > 0)) return;
  rows.push_back({contact.points, {0, -a, a, 0}, contact.normal, stiffness, 0, {}});
  rows.push_back({contact.points, {0, -b * (1 - along), -b * along, b}, contact.normal, stiffness, 0, {}});
}

ContactHessian ContactPotential::hessian(ConstVectors q, SlidingStiffness stiffness) const {
  std::vector<Vec3> buffer;
  std::vector<MergedContact> merged;
  const ConstVectors x = points(q, buffer);
  const std::span<const MergedContact> all = contacts(x, merged);
  auto rows = parallel_collect<ContactRow>(
      all.size(), potential_grain, [&](std::size_t begin, std::size_t end, auto& out) {
        for (const MergedContact& contact : all.subspan(begin, end - begin)) {
          if (contact.curvature > 0)
            out.push_back({contact.points, contact.weights, contact.normal, contact.curvature, 0, {}});
          add_tilt(contact, x, out);
        }
      });
  const std::size_t normal_rows = rows.size();
  rows.resize(normal_rows + friction_terms_.size());
  parallel_for(friction_terms_.size(), potential_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const FrictionTerm& sliding = friction_terms_[i];
      const Vec3 e = slip(sliding, x, q);
      const double length = e.norm();
      const double secant = sliding.limit * friction_law(length, friction_.stick_length).curvature;
      ContactRow& row = rows[normal_rows + i];
      row = {sliding.contact.points, sliding.weights, sliding.contact.normal, 0, secant, carried(sliding)};
      if (stiffness == SlidingStiffness::secant || length < friction_.stick_length) continue;
      row.normal = sliding.contact.normal.cross(e) / length;
      std::swap(row.normal_stiffness, row.tangential);
    }
  });
  return {*map_, rows};
}

void ContactPotential::add_hessian_product(ConstVectors q, ConstVectors p, Vectors y) const {
  hessian(q).add_hessian_product(q, p, y);
}

void ContactPotential::add_diagonal_blocks(ConstVectors q, std::span<Mat3> blocks) const {
  hessian(q).add_diagonal_blocks(q, blocks);
}

void ContactPotential::linearize(ConstVectors q, HessianSink& into, std::size_t first) const {
  hessian(q).linearize(q, into, first);
}

std::vector<PairSlip> ContactPotential::slips(ConstVectors q) const {
  std::vector<Vec3> buffer;
  const ConstVectors x = points(q, buffer);
  std::vector<PairSlip> result;
  for (const FrictionTerm& sliding : friction_terms_) {
    Vec3 e = slip(sliding, x, q);
    const double length = e.norm();
    if (length > friction_.stick_length) e *= friction_.stick_length / length;
    result.push_back({sliding.contact.key, e});
  }
  std::sort(result.begin(), result.end(), [](const PairSlip& a, const PairSlip& b) { return a.key < b.key; });
  return result;
}

}  // namespace muslin
