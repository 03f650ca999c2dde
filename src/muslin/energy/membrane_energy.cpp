#include "muslin/energy/membrane_energy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "muslin/core/error.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int lanes = element_lanes;

/// Share of the masses that buckling triangles may use, and the ratio of stiffness to mass above which they
/// use none, because float would round away the rest of the masses.
constexpr double held_share = 0.9, max_stiff = 3e4;

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

/// Computes the forces on the corners, and W.
MUSLIN_VECTOR_CODE void gradients(const MembraneEnergy::Constants& c, const Rest& rest, const Batch<3>& x,
                                  Batch<3>& g, double* w) {
  Strained s;
  strain(c, rest, x, s);
  energies_of(c, rest, s.a, s.b, w);
  stress_to_corners(rest, s, g);
}

/// Computes the positive semidefinite part of the stress: with eigenvalues m ± r its deviator is scaled and
/// its mean moved so that they become max(m ± r, 0).
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
  assert(kind != Stiffness::bounded);
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

/// Data from which the 3 by 3 blocks of a triangle's stiffness are computed.
MUSLIN_VECTOR_CODE void strained_of_kind(const MembraneEnergy::Constants& c, Stiffness kind, const Rest& rest,
                                         const Batch<3>& x, Strained& s) {
  strain(c, rest, x, s);
  stress_of_kind(kind, s);
}

/// Keeps the positive part of the stress. Scales the negative part N, times the area, so that it takes at most
/// `held` [kg] from the masses. For a motion p along one axis, with b the gradients of the corners' shape
/// functions and N = Σ sᵢ qᵢqᵢᵀ,
///
///   scale Σ |sᵢ| (∇p·qᵢ)² ≤ scale Σ |sᵢ| Σ_c (b_c·qᵢ)² |p|² = −scale N : (Σ_c b_c b_cᵀ) |p|².
MUSLIN_INLINE void bound(const Rest& rest, double scale, const double* held, Strained& s) {
  double uu[lanes], vv[lanes], uv[lanes];
  for (int l = 0; l < lanes; ++l) uu[l] = s.suu[l], vv[l] = s.svv[l], uv[l] = s.suv[l];
  project(s.suu, s.svv, s.suv);
  for (int l = 0; l < lanes; ++l) {
    const double nuu = uu[l] - s.suu[l], nvv = vv[l] - s.svv[l], nuv = uv[l] - s.suv[l];
    const double u1 = rest.d00[l], u2 = rest.d10[l], v1 = rest.d01[l], v2 = rest.d11[l];
    const double u0 = -(u1 + u2), v0 = -(v1 + v2);
    const double buckling = -scale * (nuu * (u0 * u0 + u1 * u1 + u2 * u2) + nvv * (v0 * v0 + v1 * v1 + v2 * v2) +
                                      2 * nuv * (u0 * v0 + u1 * v1 + u2 * v2));
    const double share = buckling > held[l] ? held[l] / buckling : 1;
    s.suu[l] += share * nuu;
    s.svv[l] += share * nvv;
    s.suv[l] += share * nuv;
  }
}

/// `held`: by lane, read only for the bounded stiffness [kg].
MUSLIN_VECTOR_CODE void block_factors(const MembraneEnergy::Constants& c, Stiffness kind, const Rest& rest,
                                      double scale, const double* held, const Batch<3>& x, BlockFactors& f) {
  Strained s;
  strain(c, rest, x, s);
  if (kind == Stiffness::bounded) {
    bound(rest, scale, held, s);
  } else {
    stress_of_kind(kind, s);
  }
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
  require(moduli.warp >= 0 && moduli.weft >= 0 && moduli.shear >= 0, "a membrane modulus is negative",
          "give 0 or more");
  require(std::abs(moduli.poisson) < 1, "the Poisson ratio of a membrane is not between -1 and 1",
          "give 0 to 0.5");
  const double plane_stress = 1 / (1 - moduli.poisson * moduli.poisson);
  constants_.c11 = moduli.warp * plane_stress;
  constants_.c22 = moduli.weft * plane_stress;
  constants_.c12 = moduli.poisson * std::sqrt(moduli.warp * moduli.weft) * plane_stress;
  constants_.g = moduli.shear;
  if (!pattern()) return;
  slots_ = slabs_.slots(*pattern());
  mass_shares_ = slabs_.by_entry<std::array<double, 3>>([&](std::size_t t) {
    const Vec3i& corners = shell.triangles[t];
    std::array<double, 3> shares;
    for (int c = 0; c < 3; ++c)
      shares[static_cast<std::size_t>(c)] =
          shell.areas[t] / 3 / shell.vertex_areas[static_cast<std::size_t>(corners[c])];
    return shares;
  });
  stiffness_ = slabs_.by_entry<double>([&](std::size_t t) {
    const Mat2& d = shell.inverses[t];
    const Eigen::RowVector2d first = -(d.row(0) + d.row(1));
    const double uu = d.col(0).squaredNorm() + first[0] * first[0];
    const double vv = d.col(1).squaredNorm() + first[1] * first[1];
    return shell.areas[t] * ((constants_.c11 + constants_.g) * uu + (constants_.c22 + constants_.g) * vv);
  });
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
                                          std::span<const double> masses, PairBlocks blocks) const {
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners;
    BlockFactors factors;
    double held[lanes] = {};
    for (int l = 0; kind == Stiffness::bounded && l < count; ++l) {
      const auto entry = static_cast<std::size_t>(first + l);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t c = 0; c < 3; ++c)
        least = std::min(least, mass_shares_[entry][c] *
                                    masses[static_cast<std::size_t>(slabs_.vertices()[entry][c])]);
      held[l] = scale * stiffness_[entry] < max_stiff * least ? held_share * least : 0;
    }
    slabs_.gather(first, count, x, corners);
    block_factors(constants_, kind, rests_.at(first), scale, held, corners, factors);
    unsigned rows[lanes];
    slabs_.corners_in(first, count, slab, rows);
    add_blocks(factors, count, rows, slots_.data() + first, blocks.columns);
  });
}

}  // namespace muslin
