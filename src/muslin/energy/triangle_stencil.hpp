// Provides the common part of energies of F = [a, b], the 3 by 2 deformation gradient of a triangle: F from
// the corners of a batch of triangles, forces on the corners from those conjugate to a and b, and the
// stiffness
//
//   d²W = A (C₁₁ (a·da)² + 2 C₁₂ (a·da)(b·db) + C₂₂ (b·db)² + G (a·db + b·da)²)
//       + S_uu da·da + S_vv db·db + 2 S_uv da·db,
//
// S times the area A, as a product, as diagonal blocks and as a matrix. `Moduli` gives C₁₁, C₁₂, C₂₂ and G
// [N/m] of a lane.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/element_slabs.hpp"
#include "muslin/potential/hessian_sink.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Rest data of a batch of triangles.
struct TriangleRest {
  const double *d00, *d10, *d01, *d11, *area;
};

/// Rest data by entry: the inverse rest edges (00, 10, 01, 11) [1/m] and the area [m²].
class TriangleRests {
 public:
  TriangleRests(const ElementSlabs<3>& slabs, const Shell& shell) {
    for (std::size_t i = 0; i < 4; ++i)
      rest_[i] = slabs.by_entry<double>([&](std::size_t t) { return shell.inverses[t].data()[i]; });
    rest_[4] = slabs.by_entry<double>([&](std::size_t t) { return shell.areas[t]; });
  }
  TriangleRest at(int first) const {
    return {rest_[0].data() + first, rest_[1].data() + first, rest_[2].data() + first,
            rest_[3].data() + first, rest_[4].data() + first};
  }

 private:
  std::vector<double> rest_[5];
};

inline std::vector<std::array<int, 3>> corners_of(const Shell& shell) {
  std::vector<std::array<int, 3>> corners;
  for (const Vec3i& t : shell.triangles) corners.push_back({t[0], t[1], t[2]});
  return corners;
}

/// By axis and lane.
using LaneVectors = double[3][element_lanes];

/// Deformed warp and weft, and the stress times the area.
struct StrainedTriangles {
  LaneVectors a, b;
  double suu[element_lanes], svv[element_lanes], suv[element_lanes];
};

/// Computes a and b from the corners: the differences from corner 0 times the inverse rest edges.
MUSLIN_INLINE void along_threads(const TriangleRest& rest, const Batch<3>& x, LaneVectors& a,
                                 LaneVectors& b) {
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < element_lanes; ++l) {
      const double e1 = x[1][k][l] - x[0][k][l], e2 = x[2][k][l] - x[0][k][l];
      a[k][l] = e1 * rest.d00[l] + e2 * rest.d10[l];
      b[k][l] = e1 * rest.d01[l] + e2 * rest.d11[l];
    }
  }
}

/// Computes the forces on the corners from those conjugate to a and b.
MUSLIN_INLINE void to_corners(const TriangleRest& rest, const LaneVectors& pa, const LaneVectors& pb,
                              Batch<3>& f) {
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < element_lanes; ++l) {
      f[1][k][l] = pa[k][l] * rest.d00[l] + pb[k][l] * rest.d01[l];
      f[2][k][l] = pa[k][l] * rest.d10[l] + pb[k][l] * rest.d11[l];
      f[0][k][l] = -(f[1][k][l] + f[2][k][l]);
    }
  }
}

/// Computes the forces on the corners from the stress.
MUSLIN_INLINE void stress_to_corners(const TriangleRest& rest, const StrainedTriangles& s, Batch<3>& f) {
  LaneVectors pa, pb;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < element_lanes; ++l) {
      pa[k][l] = s.suu[l] * s.a[k][l] + s.suv[l] * s.b[k][l];
      pb[k][l] = s.svv[l] * s.b[k][l] + s.suv[l] * s.a[k][l];
    }
  }
  to_corners(rest, pa, pb, f);
}

/// Computes the stiffness times a motion p of the corners.
template <class Moduli>
MUSLIN_INLINE void stiffness_product(const Moduli& c, const TriangleRest& rest, const StrainedTriangles& s,
                                     const Batch<3>& p, Batch<3>& y) {
  LaneVectors da, db, pa, pb;
  along_threads(rest, p, da, db);
  for (int l = 0; l < element_lanes; ++l) {
    double euu = 0, evv = 0, guv = 0;
    for (int k = 0; k < 3; ++k) {
      euu += s.a[k][l] * da[k][l];
      evv += s.b[k][l] * db[k][l];
      guv += s.a[k][l] * db[k][l] + s.b[k][l] * da[k][l];
    }
    const double tuu = rest.area[l] * (c.c11(l) * euu + c.c12(l) * evv);
    const double tvv = rest.area[l] * (c.c12(l) * euu + c.c22(l) * evv);
    const double tuv = rest.area[l] * (c.g(l) * guv);
    for (int k = 0; k < 3; ++k) {
      pa[k][l] = tuu * s.a[k][l] + tuv * s.b[k][l] + s.suu[l] * da[k][l] + s.suv[l] * db[k][l];
      pb[k][l] = tvv * s.b[k][l] + tuv * s.a[k][l] + s.svv[l] * db[k][l] + s.suv[l] * da[k][l];
    }
  }
  to_corners(rest, pa, pb, y);
}

/// Adds the diagonal block of corner i of lane l to `block`.
template <class Moduli>
void add_corner_block(const Moduli& c, const TriangleRest& rest, const StrainedTriangles& s, int l, int i,
                      Mat3& block) {
  const Vec3 a(s.a[0][l], s.a[1][l], s.a[2][l]), b(s.b[0][l], s.b[1][l], s.b[2][l]);
  const double u = i == 0 ? -(rest.d00[l] + rest.d10[l]) : i == 1 ? rest.d00[l] : rest.d10[l];
  const double v = i == 0 ? -(rest.d01[l] + rest.d11[l]) : i == 1 ? rest.d01[l] : rest.d11[l];
  const double area = rest.area[l];
  const double aa = area * (c.c11(l) * u * u + c.g(l) * v * v);
  const double bb = area * (c.c22(l) * v * v + c.g(l) * u * u);
  const double ab = area * (c.c12(l) + c.g(l)) * u * v;
  block += (aa * a + ab * b) * a.transpose() + (ab * a + bb * b) * b.transpose();
  block.diagonal().array() += s.suu[l] * u * u + s.svv[l] * v * v + 2 * s.suv[l] * u * v;
}

/// The parts of the block of corners i and j, for i ≤ j in the order (0,0), (0,1), (0,2), (1,1), (1,2),
/// (2,2): aa a aᵀ + ba b aᵀ + ab a bᵀ + bb b bᵀ + geometric 1, in columns along corner j.
struct BlockFactors {
  float a[3][element_lanes], b[3][element_lanes];
  float aa[6][element_lanes], ab[6][element_lanes], ba[6][element_lanes], bb[6][element_lanes],
      geometric[6][element_lanes];
};

template <class Moduli>
MUSLIN_INLINE void find_block_factors(const Moduli& c, const TriangleRest& rest, const StrainedTriangles& s,
                                      double scale, BlockFactors& f) {
  constexpr int lanes = element_lanes;
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
        f.aa[pair][l] = static_cast<float>(area[l] * (c.c11(l) * uu + c.g(l) * vv));
        f.bb[pair][l] = static_cast<float>(area[l] * (c.c22(l) * vv + c.g(l) * uu));
        f.ab[pair][l] = static_cast<float>(area[l] * (c.c12(l) * uv + c.g(l) * vu));
        f.ba[pair][l] = static_cast<float>(area[l] * (c.c12(l) * vu + c.g(l) * uv));
        f.geometric[pair][l] =
            static_cast<float>(scale * (s.suu[l] * uu + s.svv[l] * vv + s.suv[l] * (uv + vu)));
      }
    }
  }
}

/// Adds the blocks of lane l whose rows belong to corners with a bit in `rows`.
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

}  // namespace muslin
