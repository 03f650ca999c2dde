#include "muslin/contact/contact_potential.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "muslin/contact/conservative_advancement.hpp"
#include "muslin/contact/contact_energy.hpp"
#include "muslin/contact/contact_hessian.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 512;
/// Pairs this many ranges apart are taken along: they may come into range in the iteration.
constexpr double ranges_ahead = 1.5;
/// Edges fade out over this share of their length, and below this squared sine of their angle.
constexpr double end_share = 0.05, parallel_share = 1e-3;

/// Less weight of a corner than this is rounding: the closest point lies on the edge opposite to it.
constexpr double least_weight = 1e-6;

double faded(double t, double width) {
  const double y = std::min(t, 1 - t) / width;
  return y >= 1 ? 1 : y <= 0 ? 0 : y * y * (3 - 2 * y);
}

/// The share of a pair in the contact at its closest points.
double contact_share(const ContactSurface& surface, const ContactPair& pair, const PairGeometry& at,
                     ConstVectors x) {
  if (pair.kind == PairKind::point_plane) return 1;
  const auto position = [&](std::size_t i) -> const Vec3& {
    return x[static_cast<std::size_t>(pair.points[i])];
  };
  if (pair.kind == PairKind::edge_edge) {
    const Vec3 u = position(1) - position(0), v = position(3) - position(2);
    const double sine = u.cross(v).squaredNorm() / std::max(u.squaredNorm() * v.squaredNorm(), 1e-300);
    const double apart = std::min(1.0, sine / parallel_share);
    return faded(at.weights[1], end_share) * faded(-at.weights[3], end_share) * apart * (2 - apart);
  }
  std::array<int, 3> corners{};
  std::size_t count = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    const bool again =
        std::find(corners.begin(), corners.begin() + count, pair.points[i]) != corners.begin() + count;
    if (at.weights[i] < -least_weight && !again) corners[count++] = pair.points[i];
  }
  if (count == 3) return 1;
  if (count == 1) return 1.0 / surface.triangles_at_point(corners[0]);
  const Vec3i& edges = surface.triangle_edges()[static_cast<std::size_t>(pair.second)];
  for (const int e : edges) {
    if (e < 0) continue;
    const ContactSurface::Edge& ends = surface.edges()[static_cast<std::size_t>(e)];
    const bool has =
        (ends[0] == corners[0] && ends[1] == corners[1]) || (ends[0] == corners[1] && ends[1] == corners[0]);
    if (has) return 1.0 / surface.triangles_at_edge(e);
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

ContactPotential::ContactPotential(const ContactCandidates& candidates, std::shared_ptr<const SurfaceMap> map,
                                   ConstVectors lagged, Friction friction, ConstVectors start,
                                   std::span<const PairSlip> slips)
    : surface_(candidates.shared_surface()), map_(std::move(map)), friction_(friction) {
  if (!(friction.coefficient >= 0) || !(friction.stick_length > 0))
    throw Error(ErrorKind::usage, "a friction coefficient is negative",
                "give 0 or more, and a stick length above 0");
  if (lagged.size() != map_->vertex_count() || start.size() != lagged.size() ||
      surface_->point_count() != map_->point_count())
    throw Error(ErrorKind::usage, "a contact potential needs one position for each vertex",
                "give #V positions");
  std::vector<Vec3> buffer, start_buffer;
  const ConstVectors x = points(lagged, buffer), x_start = points(start, start_buffer);
  const std::span<const ContactPair> all = candidates.pairs();
  std::vector<std::vector<Pair>> parts((all.size() + grain - 1) / grain);
  std::vector<std::uint8_t> touching(parts.size(), 0);
  parallel_for(all.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const PairGeometry at = pair_geometry(*surface_, all[i], x);
      const double gap = at.distance - all[i].thickness;
      if (gap >= ranges_ahead * all[i].range) continue;
      if (!(gap > 0)) touching[begin / grain] = 1;
      const double share = contact_share(*surface_, all[i], at, x);
      if (share <= 0) continue;
      Pair pair;
      pair.pair = all[i];
      pair.stiffness = surface_->stiffness(all[i].points[0], all[i].points[last_point(all[i])]) * share;
      pair.normal = at.normal;
      pair.weights = at.weights;
      pair.begin.setZero();
      if (friction.coefficient > 0) {
        pair.friction = -friction.coefficient * pair.stiffness * contact_law(gap, all[i].range).slope;
        pair.begin = combined(all[i], at.weights, x_start);
        const std::uint64_t key = all[i].key();
        const auto known = std::lower_bound(slips.begin(), slips.end(), key,
                                            [](const PairSlip& s, std::uint64_t k) { return s.key < k; });
        if (known != slips.end() && known->key == key) pair.begin -= tangential(known->slip, at.normal);
      }
      parts[begin / grain].push_back(pair);
    }
  });
  if (std::any_of(touching.begin(), touching.end(), [](std::uint8_t t) { return t != 0; }))
    throw Error(ErrorKind::usage, "surfaces touch where contact begins", "start without intersections");
  for (const auto& part : parts) pairs_.insert(pairs_.end(), part.begin(), part.end());

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

ConstVectors ContactPotential::points(ConstVectors q, std::vector<Vec3>& buffer) const {
  if (map_->is_identity()) return q;
  buffer.resize(map_->point_count());
  map_->apply(q, buffer);
  return buffer;
}

Vec3 ContactPotential::slip(const Pair& pair, ConstVectors x) const {
  return tangential(combined(pair.pair, pair.weights, x) - pair.begin, pair.normal);
}

ContactPotential::Parts ContactPotential::parts(ConstVectors q) const {
  std::vector<Vec3> buffer;
  const ConstVectors x = points(q, buffer);
  return parallel_sum(pairs_.size(), grain, Parts{}, [&](std::size_t begin, std::size_t end) {
    Parts sum;
    for (std::size_t i = begin; i < end; ++i) {
      const Pair& pair = pairs_[i];
      const double gap = pair_geometry(*surface_, pair.pair, x).distance - pair.pair.thickness;
      sum.pressed += pair.stiffness * contact_law(gap, pair.pair.range).value;
      if (pair.friction > 0)
        sum.rubbed += pair.friction * friction_law(slip(pair, x).norm(), friction_.stick_length).value;
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
  std::vector<Vec3> forces(4 * pairs_.size());
  parallel_for(pairs_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Pair& pair = pairs_[i];
      const PairGeometry at = pair_geometry(*surface_, pair.pair, x);
      const double slope =
          pair.stiffness * contact_law(at.distance - pair.pair.thickness, pair.pair.range).slope;
      Vec3 rub = Vec3::Zero();
      if (pair.friction > 0) {
        const Vec3 e = slip(pair, x);
        rub = pair.friction * friction_law(e.norm(), friction_.stick_length).curvature * e;
      }
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
}

/// The Hessian at one q.
class ContactPotential::Hessian : public ContactHessian {
 public:
  Hessian(const ContactPotential& w, ConstVectors q) : ContactHessian(*w.map_, rows(w, q)) {}

 private:
  static std::vector<ContactRow> rows(const ContactPotential& w, ConstVectors q) {
    std::vector<Vec3> buffer;
    const ConstVectors x = w.points(q, buffer);
    const std::size_t count = w.pairs_.size();
    std::vector<ContactRow> all(2 * count);  // normal and friction of each pair
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Pair& pair = w.pairs_[i];
        const PairGeometry at = pair_geometry(*w.surface_, pair.pair, x);
        const double curvature =
            pair.stiffness * contact_law(at.distance - pair.pair.thickness, pair.pair.range).curvature;
        all[2 * i] = {pair.pair.points, at.weights, at.normal, curvature, 0};
        all[2 * i + 1] = {pair.pair.points, pair.weights, pair.normal, 0, 0};
        if (pair.friction <= 0) continue;
        const double secant =
            pair.friction * friction_law(w.slip(pair, x).norm(), w.friction_.stick_length).curvature;
        // One row is enough where nothing has moved since friction was lagged.
        all[2 * i + (at.weights == pair.weights ? 0 : 1)].tangential = secant;
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
  into.add_general(std::make_shared<Hessian>(*this, q), first, q);
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
                          if (pair.kind == PairKind::point_plane) {
                            const double approach = -at.normal.dot(combined(pair, at.weights, u));
                            if (approach > 0.9 * gap) factor = 0.9 * gap / approach;
                          } else {
                            std::array<Vec3, 4> from, by;
                            for (std::size_t k = 0; k < 4; ++k) {
                              from[k] = x[static_cast<std::size_t>(pair.points[k])];
                              by[k] = u[static_cast<std::size_t>(pair.points[k])];
                            }
                            factor = safe_fraction(pair.kind, from, by, required, 0.01 * gap);
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
    Vec3 e = slip(pair, x);
    const double length = e.norm();
    if (length > friction_.stick_length) e *= friction_.stick_length / length;
    result.push_back({pair.pair.key(), e});
  }
  std::sort(result.begin(), result.end(), [](const PairSlip& a, const PairSlip& b) { return a.key < b.key; });
  return result;
}

}  // namespace muslin
