#include "muslin/energy/membrane_energy.hpp"

#include <cassert>
#include <cmath>

#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int lanes = element_lanes;

/// Rest data of a batch of triangles.
struct Rest {
  const double *d00, *d10, *d01, *d11, *area;
};

/// What became of warp and weft, and the stress times the area.
struct Strained {
  double a[3][lanes], b[3][lanes];
  double suu[lanes], svv[lanes], suv[lanes];
};

using Vector = double[3][lanes];

/// a and b from the corners: the differences from corner 0 times the inverse rest edges.
MUSLIN_INLINE void along_threads(const Rest& rest, const Batch<3>& x, Vector& a, Vector& b) {
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < lanes; ++l) {
      const double e1 = x[1][k][l] - x[0][k][l], e2 = x[2][k][l] - x[0][k][l];
      a[k][l] = e1 * rest.d00[l] + e2 * rest.d10[l];
      b[k][l] = e1 * rest.d01[l] + e2 * rest.d11[l];
    }
  }
}

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

/// Forces on the corners from those conjugate to a and b.
MUSLIN_INLINE void to_corners(const Rest& rest, const Vector& pa, const Vector& pb, Batch<3>& f) {
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < lanes; ++l) {
      f[1][k][l] = pa[k][l] * rest.d00[l] + pb[k][l] * rest.d01[l];
      f[2][k][l] = pa[k][l] * rest.d10[l] + pb[k][l] * rest.d11[l];
      f[0][k][l] = -(f[1][k][l] + f[2][k][l]);
    }
  }
}

MUSLIN_INLINE void energies_of(const MembraneEnergy::Constants& c, const Rest& rest, const Vector& a,
                               const Vector& b, double* w) {
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
  Vector a, b;
  along_threads(rest, x, a, b);
  energies_of(c, rest, a, b, w);
}

/// Forces on the corners, and W.
MUSLIN_VECTOR_CODE void gradients(const MembraneEnergy::Constants& c, const Rest& rest, const Batch<3>& x,
                                  Batch<3>& g, double* w) {
  Strained s;
  strain(c, rest, x, s);
  energies_of(c, rest, s.a, s.b, w);
  Vector pa, pb;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < lanes; ++l) {
      pa[k][l] = s.suu[l] * s.a[k][l] + s.suv[l] * s.b[k][l];
      pb[k][l] = s.svv[l] * s.b[k][l] + s.suv[l] * s.a[k][l];
    }
  }
  to_corners(rest, pa, pb, g);
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
  Vector da, db, pa, pb;
  along_threads(rest, p, da, db);
  for (int l = 0; l < lanes; ++l) {
    double euu = 0, evv = 0, guv = 0;
    for (int k = 0; k < 3; ++k) {
      euu += s.a[k][l] * da[k][l];
      evv += s.b[k][l] * db[k][l];
      guv += s.a[k][l] * db[k][l] + s.b[k][l] * da[k][l];
    }
    const double tuu = rest.area[l] * (c.c11 * euu + c.c12 * evv);
    const double tvv = rest.area[l] * (c.c12 * euu + c.c22 * evv);
    const double tuv = rest.area[l] * (c.g * guv);
    for (int k = 0; k < 3; ++k) {
      pa[k][l] = tuu * s.a[k][l] + tuv * s.b[k][l] + s.suu[l] * da[k][l] + s.suv[l] * db[k][l];
      pb[k][l] = tvv * s.b[k][l] + tuv * s.a[k][l] + s.svv[l] * db[k][l] + s.suv[l] * da[k][l];
    }
  }
  to_corners(rest, pa, pb, y);
}

/// Everything that the 3 by 3 blocks of a triangle's stiffness are made of.
MUSLIN_VECTOR_CODE void strained_of_kind(const MembraneEnergy::Constants& c, Stiffness kind, const Rest& rest,
                                         const Batch<3>& x, Strained& s) {
  strain(c, rest, x, s);
  stress_of_kind(kind, s);
}

/// What the block of corners i and j is made of, for i ≤ j in the order (0,0), (0,1), (0,2), (1,1), (1,2),
/// (2,2): aa a aᵀ + ba b aᵀ + ab a bᵀ + bb b bᵀ + geometric 1, in columns along corner j.
struct BlockFactors {
  float a[3][lanes], b[3][lanes];
  float aa[6][lanes], ab[6][lanes], ba[6][lanes], bb[6][lanes], geometric[6][lanes];
};

MUSLIN_VECTOR_CODE void block_factors(const MembraneEnergy::Constants& c, Stiffness kind, const Rest& rest,
                                      double scale, const Batch<3>& x, BlockFactors& f) {
  Strained s;
  strain(c, rest, x, s);
  stress_of_kind(kind, s);
  double u[3][lanes], v[3][lanes], area[lanes];
  for (int l = 0; l < lanes; ++l) {
    u[0][l] = -(rest.d00[l] + rest.d10[l]), u[1][l] = rest.d00[l], u[2][l] = rest.d10[l];
    v[0][l] = -(rest.d01[l] + rest.d11[l]), v[1][l] = rest.d01[l], v[2][l] = rest.d11[l];
    area[l] = scale * rest.area[l];
  }
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < lanes; ++l) {
      f.a[k][l] = static_cast<float>(s.a[k][l]);
      f.b[k][l] = static_cast<float>(s.b[k][l]);
    }
  }
  int pair = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j, ++pair) {
      for (int l = 0; l < lanes; ++l) {
        const double uu = u[i][l] * u[j][l], vv = v[i][l] * v[j][l];
        const double uv = u[i][l] * v[j][l], vu = v[i][l] * u[j][l];
        f.aa[pair][l] = static_cast<float>(area[l] * (c.c11 * uu + c.g * vv));
        f.bb[pair][l] = static_cast<float>(area[l] * (c.c22 * vv + c.g * uu));
        f.ab[pair][l] = static_cast<float>(area[l] * (c.c12 * uv + c.g * vu));
        f.ba[pair][l] = static_cast<float>(area[l] * (c.c12 * vu + c.g * uv));
        f.geometric[pair][l] =
            static_cast<float>(scale * (s.suu[l] * uu + s.svv[l] * vv + s.suv[l] * (uv + vu)));
      }
    }
  }
}

/// Adds the blocks of lane l whose rows are of corners that `rows` has a bit for.
MUSLIN_INLINE void add_block_rows(const BlockFactors& f, int l, unsigned rows,
                                  const ElementSlabs<3>::Slots& slots, Float4* blocks) {
  const Float4 a = {f.a[0][l], f.a[1][l], f.a[2][l], 0}, b = {f.b[0][l], f.b[1][l], f.b[2][l], 0};
  Float4 by_a[2][3], by_b[2][3];
  for (int k = 0; k < 3; ++k) {
    by_a[0][k] = a[k] * a, by_a[1][k] = a[k] * b;
    by_b[0][k] = b[k] * a, by_b[1][k] = b[k] * b;
  }
  constexpr Float4 unit[3] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  const auto add = [&](int slot, int pair, float ab, float ba) {
    Float4* const block = blocks + 3 * static_cast<std::ptrdiff_t>(slot);
    for (int k = 0; k < 3; ++k) {
      block[k] += (f.aa[pair][l] * by_a[0][k] + ab * by_b[0][k]) +
                  (ba * by_a[1][k] + f.bb[pair][l] * by_b[1][k]) + f.geometric[pair][l] * unit[k];
    }
  };
  int pair = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j, ++pair) {
      const int slot = slots[static_cast<std::size_t>(pair)];
      if (slot >= 0) {
        if ((rows >> i & 1U) != 0) add(slot, pair, f.ab[pair][l], f.ba[pair][l]);
      } else {
        if ((rows >> j & 1U) != 0) add(~slot, pair, f.ba[pair][l], f.ab[pair][l]);
      }
    }
  }
}
MUSLIN_VECTOR_CODE void add_blocks(const BlockFactors& f, int count, const unsigned* rows,
                                   const ElementSlabs<3>::Slots* slots, Float4* blocks) {
  for (int l = 0; l < count; ++l) add_block_rows(f, l, rows[l], slots[l], blocks);
}

std::vector<std::array<int, 3>> corners_of(const Shell& shell) {
  std::vector<std::array<int, 3>> corners;
  for (const Vec3i& t : shell.triangles) corners.push_back({t[0], t[1], t[2]});
  return corners;
}

Rest rest_at(const std::vector<double> (&rest)[5], int first) {
  return {rest[0].data() + first, rest[1].data() + first, rest[2].data() + first, rest[3].data() + first,
          rest[4].data() + first};
}

}  // namespace

MembraneEnergy::MembraneEnergy(const Shell& shell, const MembraneModuli& moduli,
                               std::shared_ptr<const SymmetricPattern> block_pattern)
    : ShellEnergy(std::move(block_pattern)), slabs_(corners_of(shell), shell.vertex_count()) {
  assert(moduli.warp >= 0 && moduli.weft >= 0 && moduli.shear >= 0 && std::abs(moduli.poisson) < 1);
  const double plane_stress = 1 / (1 - moduli.poisson * moduli.poisson);
  constants_.c11 = moduli.warp * plane_stress;
  constants_.c22 = moduli.weft * plane_stress;
  constants_.c12 = moduli.poisson * std::sqrt(moduli.warp * moduli.weft) * plane_stress;
  constants_.g = moduli.shear;
  for (std::size_t i = 0; i < 4; ++i) {
    rest_[i] = slabs_.by_entry<double>([&](std::size_t t) { return shell.inverses[t].data()[i]; });
  }
  rest_[4] = slabs_.by_entry<double>([&](std::size_t t) { return shell.areas[t]; });
  if (pattern()) slots_ = slabs_.slots(*pattern());
}

double MembraneEnergy::value(ConstVectors x) const {
  return slabs_.sum(0.0, [&](int first, int count) {
    Batch<3> corners;
    slabs_.gather(first, count, x, corners);
    double w[lanes], sum = 0;
    energies(constants_, rest_at(rest_, first), corners, w);
    for (int l = 0; l < count; ++l) sum += w[l];
    return sum;
  });
}

double MembraneEnergy::add_gradient_and_value(ConstVectors x, Vectors g) const {
  return slabs_.sum_of_batches([&](int first, int count, int owned, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners, force;
    double w[lanes], sum = 0;
    slabs_.gather(first, count, x, corners);
    gradients(constants_, rest_at(rest_, first), corners, force, w);
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
    products(constants_, kind, rest_at(rest_, first), corners, along, force);
    slabs_.scatter(first, count, slab, force, y);
  });
}

void MembraneEnergy::add_stiffness_blocks(Stiffness kind, ConstVectors x, std::span<Mat3> blocks) const {
  const auto& c = constants_;
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<3>::Slab& slab) {
    Batch<3> corners;
    Strained s;
    slabs_.gather(first, count, x, corners);
    const Rest rest = rest_at(rest_, first);
    strained_of_kind(c, kind, rest, corners, s);
    for (int l = 0; l < count; ++l) {
      const Vec3 a(s.a[0][l], s.a[1][l], s.a[2][l]), b(s.b[0][l], s.b[1][l], s.b[2][l]);
      const double u[3] = {-(rest.d00[l] + rest.d10[l]), rest.d00[l], rest.d10[l]};
      const double v[3] = {-(rest.d01[l] + rest.d11[l]), rest.d01[l], rest.d11[l]};
      const auto& vertices = slabs_.vertices()[static_cast<std::size_t>(first + l)];
      for (std::size_t i = 0; i < 3; ++i) {
        const int at = vertices[i];
        if (at < slab.vertex_begin || at >= slab.vertex_end) continue;
        const double area = rest.area[l];
        const double aa = area * (c.c11 * u[i] * u[i] + c.g * v[i] * v[i]);
        const double bb = area * (c.c22 * v[i] * v[i] + c.g * u[i] * u[i]);
        const double ab = area * (c.c12 + c.g) * u[i] * v[i];
        Mat3& block = blocks[static_cast<std::size_t>(at)];
        block += (aa * a + ab * b) * a.transpose() + (ab * a + bb * b) * b.transpose();
        block.diagonal().array() +=
            s.suu[l] * u[i] * u[i] + s.svv[l] * v[i] * v[i] + 2 * s.suv[l] * u[i] * v[i];
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
    block_factors(constants_, kind, rest_at(rest_, first), scale, corners, factors);
    unsigned rows[lanes];
    slabs_.corners_in(first, count, slab, rows);
    add_blocks(factors, count, rows, slots_.data() + first, matrix.block(0));
  });
}

}  // namespace muslin
