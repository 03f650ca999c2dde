#include "muslin/energy/membrane_energy.hpp"

#include <cassert>
#include <cmath>

#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int lanes = element_lanes;

using Rest = TriangleRest;
using Strained = StrainedTriangles;

/// Moduli that all lanes share.
struct Moduli {
  const MembraneEnergy::Constants& constants;
  MUSLIN_INLINE double c11(int) const { return constants.c11; }
  MUSLIN_INLINE double c12(int) const { return constants.c12; }
  MUSLIN_INLINE double c22(int) const { return constants.c22; }
  MUSLIN_INLINE double g(int) const { return constants.g; }
};

MUSLIN_INLINE void strain(const MembraneEnergy::Constants& c, const Rest& rest, const Batch<3>& x,
                          Strained& s) {
  along_threads(rest, x, s.a, s.b);
  for (int l = 0; l < lanes; ++l) {
    const double aa = s.a[0][l] * s.a[0][l] + s.a[1][l] * s.a[1][l] + s.a[2][l] * s.a[2][l];
    const double bb = s.b[0][l] * s.b[0][l] + s.b[1][l] * s.b[1][l] + s.b[2][l] * s.b[2][l];
    const double ab = s.a[0][l] * s.b[0][l] + s.a[1][l] * s.b[1][l] + s.a[2][l] * s.b[2][l];
    const double euu = 0.5 * (aa - 1), evv = 0.5 * (bb - 1);
    s.suu[l] = rest.area[l] * (c.c11 * euu + c.c12 * evv);
    s.svv[l] = rest.area[l] * (c.c12 * euu + c.c22 * evv);
    s.suv[l] = rest.area[l] * (c.g * ab);
  }
}

MUSLIN_INLINE void energies_of(const MembraneEnergy::Constants& c, const Rest& rest, const LaneVectors& a,
                               const LaneVectors& b, double* w) {
  for (int l = 0; l < lanes; ++l) {
    const double aa = a[0][l] * a[0][l] + a[1][l] * a[1][l] + a[2][l] * a[2][l];
    const double bb = b[0][l] * b[0][l] + b[1][l] * b[1][l] + b[2][l] * b[2][l];
    const double ab = a[0][l] * b[0][l] + a[1][l] * b[1][l] + a[2][l] * b[2][l];
    const double euu = 0.5 * (aa - 1), evv = 0.5 * (bb - 1);
    w[l] = 0.5 * rest.area[l] *
           (c.c11 * (euu * euu) + 2 * c.c12 * (euu * evv) + c.c22 * (evv * evv) + c.g * (ab * ab));
  }
}
MUSLIN_VECTOR_CODE void energies(const MembraneEnergy::Constants& c, const Rest& rest, const Batch<3>& x,
                                 double* w) {
  LaneVectors a, b;
  along_threads(rest, x, a, b);
  energies_of(c, rest, a, b, w);
}

/// Forces on the corners, and W.
MUSLIN_VECTOR_CODE void gradients(const MembraneEnergy::Constants& c, const Rest& rest, const Batch<3>& x,
                                  Batch<3>& g, double* w) {
  Strained s;
  strain(c, rest, x, s);
  energies_of(c, rest, s.a, s.b, w);
  stress_to_corners(rest, s, g);
}

/// The positive semidefinite part of the stress: with eigenvalues m ± r its deviator is scaled and its mean
/// moved so that they become max(m ± r, 0).
MUSLIN_INLINE void project(double* suu, double* svv, double* suv) {
  for (int l = 0; l < lanes; ++l) {
    const double mean = 0.5 * (suu[l] + svv[l]), half = 0.5 * (suu[l] - svv[l]), shear = suv[l];
    const double r = std::sqrt(half * half + shear * shear);
    const double high = mean + r > 0 ? mean + r : 0, low = mean - r > 0 ? mean - r : 0;
    const double scale = r > 0 ? 0.5 * (high - low) / r : 0;
    suu[l] = 0.5 * (high + low) + scale * half;
    svv[l] = 0.5 * (high + low) - scale * half;
    suv[l] = scale * shear;
  }
}

MUSLIN_INLINE void stress_of_kind(Stiffness kind, Strained& s) {
  if (kind == Stiffness::projected) project(s.suu, s.svv, s.suv);
  if (kind != Stiffness::material) return;
  for (int l = 0; l < lanes; ++l) s.suu[l] = s.svv[l] = s.suv[l] = 0;
}

MUSLIN_VECTOR_CODE void products(const MembraneEnergy::Constants& c, Stiffness kind, const Rest& rest,
                                 const Batch<3>& x, const Batch<3>& p, Batch<3>& y) {
  Strained s;
  strain(c, rest, x, s);
  stress_of_kind(kind, s);
  stiffness_product(Moduli{c}, rest, s, p, y);
}

/// Everything that the 3 by 3 blocks of a triangle's stiffness are made of.
MUSLIN_VECTOR_CODE void strained_of_kind(const MembraneEnergy::Constants& c, Stiffness kind, const Rest& rest,
                                         const Batch<3>& x, Strained& s) {
  strain(c, rest, x, s);
  stress_of_kind(kind, s);
}

MUSLIN_VECTOR_CODE void block_factors(const MembraneEnergy::Constants& c, Stiffness kind, const Rest& rest,
                                      double scale, const Batch<3>& x, BlockFactors& f) {
  Strained s;
  strain(c, rest, x, s);
  stress_of_kind(kind, s);
  find_block_factors(Moduli{c}, rest, s, scale, f);
}

MUSLIN_VECTOR_CODE void add_blocks(const BlockFactors& f, int count, const unsigned* rows,
                                   const ElementSlabs<3>::Slots* slots, Float4* blocks) {
  for (int l = 0; l < count; ++l) add_block_rows(f, l, rows[l], slots[l], blocks);
}

}  // namespace

MembraneEnergy::MembraneEnergy(const Shell& shell, const MembraneModuli& moduli,
                               std::shared_ptr<const SymmetricPattern> block_pattern)
    : ShellEnergy(std::move(block_pattern)),
      slabs_(corners_of(shell), shell.vertex_count()),
      rests_(slabs_, shell) {
  assert(moduli.warp >= 0 && moduli.weft >= 0 && moduli.shear >= 0 && std::abs(moduli.poisson) < 1);
  const double plane_stress = 1 / (1 - moduli.poisson * moduli.poisson);
  constants_.c11 = moduli.warp * plane_stress;
  constants_.c22 = moduli.weft * plane_stress;
  constants_.c12 = moduli.poisson * std::sqrt(moduli.warp * moduli.weft) * plane_stress;
  constants_.g = moduli.shear;
  if (pattern()) slots_ = slabs_.slots(*pattern());
}

double MembraneEnergy::value(ConstVectors x) const {
  return slabs_.sum(0.0, [&](int first, int count) {
    Batch<3> corners;
    slabs_.gather(first, count, x, corners);
    double w[lanes], sum = 0;
    energies(constants_, rests_.at(first), corners, w);
    for (int l = 0; l < count; ++l) sum += w[l];
    return sum;
  });
}

double MembraneEnergy::add_gradient_and_value(ConstVectors x, Vectors g) const {
  return slabs_.sum_of_batches([&](int first, int count, int owned, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners, force;
    double w[lanes], sum = 0;
    slabs_.gather(first, count, x, corners);
    gradients(constants_, rests_.at(first), corners, force, w);
    slabs_.scatter(first, count, slab, force, g);
    for (int l = 0; l < owned; ++l) sum += w[l];
    return sum;
  });
}

void MembraneEnergy::add_gradient(ConstVectors x, Vectors g) const { add_gradient_and_value(x, g); }

void MembraneEnergy::add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const {
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners, along, force;
    slabs_.gather(first, count, x, corners);
    slabs_.gather(first, count, p, along);
    products(constants_, kind, rests_.at(first), corners, along, force);
    slabs_.scatter(first, count, slab, force, y);
  });
}

void MembraneEnergy::add_stiffness_blocks(Stiffness kind, ConstVectors x, std::span<Mat3> blocks) const {
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners;
    Strained s;
    slabs_.gather(first, count, x, corners);
    const Rest rest = rests_.at(first);
    strained_of_kind(constants_, kind, rest, corners, s);
    for (int l = 0; l < count; ++l) {
      const auto& vertices = slabs_.vertices()[static_cast<std::size_t>(first + l)];
      for (int i = 0; i < 3; ++i) {
        const int at = vertices[static_cast<std::size_t>(i)];
        if (at < slab.vertex_begin || at >= slab.vertex_end) continue;
        add_corner_block(Moduli{constants_}, rest, s, l, i, blocks[static_cast<std::size_t>(at)]);
      }
    }
  });
}

void MembraneEnergy::add_stiffness_matrix(Stiffness kind, ConstVectors x, double scale,
                                          SymmetricMatrix& matrix) const {
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners;
    BlockFactors factors;
    slabs_.gather(first, count, x, corners);
    block_factors(constants_, kind, rests_.at(first), scale, corners, factors);
    unsigned rows[lanes];
    slabs_.corners_in(first, count, slab, rows);
    add_blocks(factors, count, rows, slots_.data() + first, matrix.block(0));
  });
}

}  // namespace muslin
