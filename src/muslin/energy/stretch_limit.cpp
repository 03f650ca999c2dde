#include "muslin/energy/stretch_limit.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/core/error.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int lanes = element_lanes;
constexpr double gravity = 9.81;        // [m/s²]
constexpr double end_of_barrier = 0.5;  // share of the range from onset to limit
// Stretches closer to each other than this share of that range count as equal where their difference is a
// divisor.
constexpr double equal = 1e-6;

/// FᵀF in (warp, weft), by its eigenvalues mean ± radius and the direction of the larger one.
struct Stretched : StrainedTriangles {
  double mean[lanes], half[lanes], shear[lanes];
};

/// True if a triangle of the batch is stretched beyond the onset, `square` being that of the latter.
MUSLIN_VECTOR_CODE bool exceeds(double square, const TriangleRest& rest, const Batch<3>& x, Stretched& s) {
  along_threads(rest, x, s.a, s.b);
  double excess[lanes];
  for (int l = 0; l < lanes; ++l) {
    const double aa = s.a[0][l] * s.a[0][l] + s.a[1][l] * s.a[1][l] + s.a[2][l] * s.a[2][l];
    const double bb = s.b[0][l] * s.b[0][l] + s.b[1][l] * s.b[1][l] + s.b[2][l] * s.b[2][l];
    const double ab = s.a[0][l] * s.b[0][l] + s.a[1][l] * s.b[1][l] + s.a[2][l] * s.b[2][l];
    s.mean[l] = 0.5 * (aa + bb), s.half[l] = 0.5 * (aa - bb), s.shear[l] = ab;
    // mean + radius > square, without the root.
    const double room = square - s.mean[l];
    const double radius_squared = s.half[l] * s.half[l] + ab * ab;
    excess[l] = room < 0 ? 1 : radius_squared - room * room;
  }
  bool any = false;
  for (int l = 0; l < lanes; ++l) any |= excess[l] > 0;
  return any;
}

/// The energy of a triangle in its principal directions, κ = 1 and per area.
struct Principal {
  StretchBarrier::Law law[2];  // of the larger stretch and of the smaller one
  double stretch[2];
  double cosine, sine;  // of twice the angle from warp to the larger stretch
  double radius;        // half the difference of the squares of the stretches
};

Principal principal(const StretchBarrier& barrier, double mean, double half, double shear) {
  Principal p;
  p.radius = std::sqrt(half * half + shear * shear);
  p.cosine = p.radius > 0 ? half / p.radius : 1;
  p.sine = p.radius > 0 ? shear / p.radius : 0;
  p.stretch[0] = std::sqrt(mean + p.radius);
  p.stretch[1] = std::sqrt(std::max(mean - p.radius, 0.0));
  p.law[0] = barrier.at(p.stretch[0]);
  p.law[1] = barrier.at(p.stretch[1]);
  return p;
}

/// ψ'/λ: the stress in a principal direction. Below the onset it is zero.
double stress(const Principal& p, int i) { return p.law[i].slope > 0 ? p.law[i].slope / p.stretch[i] : 0; }

double energy(const Principal& p) { return p.law[0].value + p.law[1].value; }

/// The energy of the first `count` triangles.
double energies(const StretchBarrier& barrier, double stiffness, const TriangleRest& rest, const Stretched& s,
                int count) {
  double sum = 0;
  for (int l = 0; l < count; ++l)
    sum += stiffness * rest.area[l] * energy(principal(barrier, s.mean[l], s.half[l], s.shear[l]));
  return sum;
}

/// Finds the stress in (warp, weft) times the area; returns the energy of the first `owned` triangles.
double find_stresses(const StretchBarrier& barrier, double stiffness, const TriangleRest& rest, Stretched& s,
                     int owned) {
  double sum = 0;
  for (int l = 0; l < lanes; ++l) {
    const Principal p = principal(barrier, s.mean[l], s.half[l], s.shear[l]);
    const double force = stiffness * rest.area[l], high = stress(p, 0), low = stress(p, 1);
    const double mean = 0.5 * (high + low), deviator = 0.5 * (high - low);
    s.suu[l] = force * (mean + deviator * p.cosine);
    s.svv[l] = force * (mean - deviator * p.cosine);
    s.suv[l] = force * (deviator * p.sine);
    if (l < owned) sum += force * energy(p);
  }
  return sum;
}

MUSLIN_VECTOR_CODE void forces(const TriangleRest& rest, const StrainedTriangles& s, Batch<3>& f) {
  stress_to_corners(rest, s, f);
}

/// Stiffness in the principal directions: those of the larger and the smaller stretch in place of warp and
/// weft, so that nothing couples them but shear.
struct Stiffnesses {
  double along[2][lanes], across[lanes];  // [N/m]
  MUSLIN_INLINE double c11(int l) const { return along[0][l]; }
  MUSLIN_INLINE double c12(int) const { return 0; }
  MUSLIN_INLINE double c22(int l) const { return along[1][l]; }
  MUSLIN_INLINE double g(int l) const { return across[l]; }
};

/// Rest data turned to the principal directions.
struct Turned {
  double d00[lanes], d10[lanes], d01[lanes], d11[lanes];
  TriangleRest with(const double* area) const { return {d00, d10, d01, d11, area}; }
};

/// G = (ψ'(λ₁)/λ₁ − ψ'(λ₂)/λ₂) / (λ₁² − λ₂²). Where the stretches are all but equal, a difference of rounded
/// numbers is meaningless; there it is the derivative of ψ'/λ halfway between them, over 2 λ.
double shear_stiffness(const StretchBarrier& barrier, const Principal& p) {
  const double high = p.stretch[0], low = p.stretch[1];
  if (2 * p.radius > equal * (barrier.limit() - barrier.onset()) * (high + low))
    return (stress(p, 0) - stress(p, 1)) / (2 * p.radius);
  const double middle = 0.5 * (high + low);
  const StretchBarrier::Law law = barrier.at(middle);
  if (law.curvature == 0) return 0;
  return (law.curvature - law.slope / middle) / (2 * middle * middle);
}

/// c = cos and s = sin of half the angle.
void halve(double cosine, double sine, double& c, double& s) {
  if (cosine >= 0) {
    c = std::sqrt(0.5 * (1 + cosine));
    s = 0.5 * sine / c;
  } else {
    s = std::copysign(std::sqrt(0.5 * (1 - cosine)), sine);
    c = 0.5 * sine / s;
  }
}

/// Data for the stiffness of a batch: F and S in the principal directions.
struct StiffBatch {
  Turned turned;
  Stiffnesses moduli;
  StrainedTriangles strained;
};

/// With δᵢ = dF vᵢ and fᵢ = F vᵢ,
///
///   d²W/(A κ) = Σ (hᵢ (fᵢ·δᵢ)² + gᵢ δᵢ²) + G (f₁·δ₂ + f₂·δ₁)²,   gᵢ = ψ'ᵢ/λᵢ,   hᵢ = (ψ''ᵢ − gᵢ)/λᵢ².
void find_stiffness(const StretchBarrier& barrier, double stiffness, Stiffness kind, const TriangleRest& rest,
                    const Stretched& s, StiffBatch& out) {
  Turned& turned = out.turned;
  StrainedTriangles& strained = out.strained;
  const bool material = kind == Stiffness::material;
  for (int l = 0; l < lanes; ++l) {
    const Principal p = principal(barrier, s.mean[l], s.half[l], s.shear[l]);
    double cosine, sine;
    halve(p.cosine, p.sine, cosine, sine);
    turned.d00[l] = cosine * rest.d00[l] + sine * rest.d01[l];
    turned.d10[l] = cosine * rest.d10[l] + sine * rest.d11[l];
    turned.d01[l] = cosine * rest.d01[l] - sine * rest.d00[l];
    turned.d11[l] = cosine * rest.d11[l] - sine * rest.d10[l];
    for (int k = 0; k < 3; ++k) {
      strained.a[k][l] = cosine * s.a[k][l] + sine * s.b[k][l];
      strained.b[k][l] = cosine * s.b[k][l] - sine * s.a[k][l];
    }
    double pull[2];
    for (int i = 0; i < 2; ++i) {
      pull[i] = material ? 0 : stress(p, i);
      const double change = p.law[i].curvature - pull[i], square = p.stretch[i] * p.stretch[i];
      out.moduli.along[i][l] = p.law[i].curvature > 0 ? stiffness * change / square : 0;
    }
    out.moduli.across[l] = material ? 0 : stiffness * shear_stiffness(barrier, p);
    strained.suu[l] = stiffness * rest.area[l] * pull[0];
    strained.svv[l] = stiffness * rest.area[l] * pull[1];
    strained.suv[l] = 0;
  }
}

MUSLIN_VECTOR_CODE void products(const StiffBatch& s, const TriangleRest& rest, const Batch<3>& p,
                                 Batch<3>& y) {
  stiffness_product(s.moduli, s.turned.with(rest.area), s.strained, p, y);
}

MUSLIN_VECTOR_CODE void add_blocks(const StiffBatch& s, const TriangleRest& rest, double scale, int count,
                                   const unsigned* rows, const ElementSlabs<3>::Slots* slots,
                                   Float4* blocks) {
  BlockFactors factors;
  find_block_factors(s.moduli, s.turned.with(rest.area), s.strained, scale, factors);
  for (int l = 0; l < count; ++l) add_block_rows(factors, l, rows[l], slots[l], blocks);
}

}  // namespace

StretchBarrier::StretchBarrier(double limit)
    : limit_(limit),
      onset_(0.5 * (1 + limit)),
      width_(limit_ - onset_),
      stiff_(onset_ + end_of_barrier * width_),
      there_(barrier(end_of_barrier)) {
  require(limit > 1, "a stretch limit is not above 1", "give the largest length over the rest length");
}

StretchBarrier::Law StretchBarrier::barrier(double u) const {
  const double log = std::log(1 - u), steep = u / (1 - u);
  return {-width_ * width_ * u * u * log, width_ * u * (steep - 2 * log), steep * (4 + steep) - 2 * log};
}

StretchBarrier::Law StretchBarrier::at(double stretch) const {
  if (!(stretch > onset_)) return {};
  if (stretch < stiff_) return barrier((stretch - onset_) / width_);
  const double beyond = stretch - stiff_;
  return {there_.value + beyond * (there_.slope + 0.5 * there_.curvature * beyond),
          there_.slope + there_.curvature * beyond, there_.curvature};
}

double stretch_limit_stiffness(double membrane, double mass, double mean_edge, double limit) {
  return 2 * std::max(membrane, mass * gravity / (mean_edge * (limit - 1)));
}

StretchLimitEnergy::StretchLimitEnergy(const Shell& shell, double limit, double stiffness,
                                       std::shared_ptr<const SymmetricPattern> block_pattern)
    : ShellEnergy(std::move(block_pattern)),
      barrier_(limit),
      stiffness_(stiffness),
      slabs_(corners_of(shell), shell.vertex_count()),
      rests_(slabs_, shell) {
  require(stiffness >= 0, "the stiffness of a stretch limit is negative", "give 0 or more");
  if (pattern()) slots_ = slabs_.slots(*pattern());
}

double StretchLimitEnergy::value(ConstVectors x) const {
  const double square = barrier_.onset() * barrier_.onset();
  return slabs_.sum(0.0, [&](int first, int count) {
    Batch<3> corners;
    Stretched s;
    slabs_.gather(first, count, x, corners);
    const TriangleRest rest = rests_.at(first);
    return exceeds(square, rest, corners, s) ? energies(barrier_, stiffness_, rest, s, count) : 0.0;
  });
}

double StretchLimitEnergy::add_gradient_and_value(ConstVectors x, Vectors g) const {
  const double square = barrier_.onset() * barrier_.onset();
  return slabs_.sum_of_batches([&](int first, int count, int owned, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners;
    Stretched s;
    slabs_.gather(first, count, x, corners);
    const TriangleRest rest = rests_.at(first);
    if (!exceeds(square, rest, corners, s)) return 0.0;
    const double sum = find_stresses(barrier_, stiffness_, rest, s, owned);
    Batch<3> force;
    forces(rest, s, force);
    slabs_.scatter(first, count, slab, force, g);
    return sum;
  });
}

void StretchLimitEnergy::add_gradient(ConstVectors x, Vectors g) const { add_gradient_and_value(x, g); }

void StretchLimitEnergy::add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p,
                                               Vectors y) const {
  const double square = barrier_.onset() * barrier_.onset();
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners;
    Stretched s;
    slabs_.gather(first, count, x, corners);
    const TriangleRest rest = rests_.at(first);
    if (!exceeds(square, rest, corners, s)) return;
    StiffBatch stiff;
    find_stiffness(barrier_, stiffness_, kind, rest, s, stiff);
    Batch<3> along, force;
    slabs_.gather(first, count, p, along);
    products(stiff, rest, along, force);
    slabs_.scatter(first, count, slab, force, y);
  });
}

void StretchLimitEnergy::add_stiffness_blocks(Stiffness kind, ConstVectors x, std::span<Mat3> blocks) const {
  const double square = barrier_.onset() * barrier_.onset();
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners;
    Stretched s;
    slabs_.gather(first, count, x, corners);
    const TriangleRest rest = rests_.at(first);
    if (!exceeds(square, rest, corners, s)) return;
    StiffBatch stiff;
    find_stiffness(barrier_, stiffness_, kind, rest, s, stiff);
    const TriangleRest turned = stiff.turned.with(rest.area);
    for (int l = 0; l < count; ++l) {
      const auto& vertices = slabs_.vertices()[static_cast<std::size_t>(first + l)];
      for (int i = 0; i < 3; ++i) {
        const int at = vertices[static_cast<std::size_t>(i)];
        if (at < slab.vertex_begin || at >= slab.vertex_end) continue;
        add_corner_block(stiff.moduli, turned, stiff.strained, l, i, blocks[static_cast<std::size_t>(at)]);
      }
    }
  });
}

void StretchLimitEnergy::add_stiffness_matrix(Stiffness kind, ConstVectors x, double scale,
                                              std::span<const double> /*masses*/, PairBlocks blocks) const {
  const double square = barrier_.onset() * barrier_.onset();
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners;
    Stretched s;
    slabs_.gather(first, count, x, corners);
    const TriangleRest rest = rests_.at(first);
    if (!exceeds(square, rest, corners, s)) return;
    StiffBatch stiff;
    find_stiffness(barrier_, stiffness_, kind, rest, s, stiff);
    unsigned rows[lanes];
    slabs_.corners_in(first, count, slab, rows);
    add_blocks(stiff, rest, scale, count, rows, slots_.data() + first, blocks.columns);
  });
}

}  // namespace muslin
