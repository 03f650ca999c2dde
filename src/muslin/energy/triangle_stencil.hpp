// TriangleStencil is a triangle with the deformation gradient F = [a, b], 3 by 2: a and b are the deformed
// unit vectors of warp and weft. Its measure is the metric FᵀF, so that no law can resist rigid motions. Laws
// give
//
//   energy       A ψ
//   stress       A S = A ∂ψ/∂E in (warp, weft), E = ½ (FᵀF − 1):
//
//     dW = Σ A (S_uu a·da + S_vv b·db + S_uv (a·db + b·da))
//
//   moduli       C₁₁, C₁₂, C₂₂ and G [N/m] in
//
//     d²W = A (C₁₁ (a·da)² + 2 C₁₂ (a·da)(b·db) + C₂₂ (b·db)² + G (a·db + b·da)²)
//         + A (S_uu da·da + S_vv db·db + 2 S_uv da·db),
//
// in (warp, weft). A law with `principal` gives the moduli and S in the directions of the principal stretches
// instead. A law with `excess` stores no energy where `excess` is not positive. See membrane_law.hpp and
// stretch_limit_law.hpp.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/element_slabs.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// FᵀF in (warp, weft).
struct Metric {
  double aa, bb, ab;
};
/// A symmetric stress in a plane.
struct PlaneStress {
  double uu, vv, uv;
};
struct PlaneModuli {
  double c11, c12, c22, g;
};
/// The stiffness of a law in principal directions, at half the angle of this cosine and sine from warp.
struct PrincipalStiffness {
  double cosine, sine;
  PlaneModuli moduli;
  PlaneStress stress;
};

/// Rest data of a batch of triangles.
struct TriangleRest {
  const double *d00, *d10, *d01, *d11, *area;
};

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

/// Replaces the stress by its positive semidefinite part: with eigenvalues m ± r its deviator is scaled and
/// its mean moved so that they become max(m ± r, 0).
MUSLIN_INLINE void cut_compression(double* suu, double* svv, double* suv) {
  for (int l = 0; l < element_lanes; ++l) {
    const double mean = 0.5 * (suu[l] + svv[l]), half = 0.5 * (suu[l] - svv[l]), shear = suv[l];
    const double r = std::sqrt(half * half + shear * shear);
    const double high = mean + r > 0 ? mean + r : 0, low = mean - r > 0 ? mean - r : 0;
    const double scale = r > 0 ? 0.5 * (high - low) / r : 0;
    suu[l] = 0.5 * (high + low) + scale * half;
    svv[l] = 0.5 * (high + low) - scale * half;
    suv[l] = scale * shear;
  }
}

/// Keeps the positive part of the stress. Scales the negative part N, times the area, so that it takes at
/// most `held` [kg] from the masses. For a motion p along one axis, with b the gradients of the corners'
/// shape functions and N = Σ sᵢ qᵢqᵢᵀ,
///
///   scale Σ |sᵢ| (∇p·qᵢ)² ≤ scale Σ |sᵢ| Σ_c (b_c·qᵢ)² |p|² = −scale N : (Σ_c b_c b_cᵀ) |p|².
MUSLIN_INLINE void bound_compression(const TriangleRest& rest, double scale, const double* held,
                                     StrainedTriangles& s) {
  constexpr int lanes = element_lanes;
  double uu[lanes], vv[lanes], uv[lanes];
  for (int l = 0; l < lanes; ++l) uu[l] = s.suu[l], vv[l] = s.svv[l], uv[l] = s.suv[l];
  cut_compression(s.suu, s.svv, s.suv);
  for (int l = 0; l < lanes; ++l) {
    const double nuu = uu[l] - s.suu[l], nvv = vv[l] - s.svv[l], nuv = uv[l] - s.suv[l];
    const double u1 = rest.d00[l], u2 = rest.d10[l], v1 = rest.d01[l], v2 = rest.d11[l];
    const double u0 = -(u1 + u2), v0 = -(v1 + v2);
    const double buckling =
        -scale * (nuu * (u0 * u0 + u1 * u1 + u2 * u2) + nvv * (v0 * v0 + v1 * v1 + v2 * v2) +
                  2 * nuv * (u0 * v0 + u1 * v1 + u2 * v2));
    const double share = buckling > held[l] ? held[l] / buckling : 1;
    s.suu[l] += share * nuu;
    s.svv[l] += share * nvv;
    s.suv[l] += share * nuv;
  }
}

MUSLIN_INLINE Metric metric(const LaneVectors& a, const LaneVectors& b, int l) {
  return {a[0][l] * a[0][l] + a[1][l] * a[1][l] + a[2][l] * a[2][l],
          b[0][l] * b[0][l] + b[1][l] * b[1][l] + b[2][l] * b[2][l],
          a[0][l] * b[0][l] + a[1][l] * b[1][l] + a[2][l] * b[2][l]};
}

/// c = cos and s = sin of half the angle.
MUSLIN_INLINE void halve_angle(double cosine, double sine, double& c, double& s) {
  if (cosine >= 0) {
    c = std::sqrt(0.5 * (1 + cosine));
    s = 0.5 * sine / c;
  } else {
    s = std::copysign(std::sqrt(0.5 * (1 - cosine)), sine);
    c = 0.5 * sine / s;
  }
}

class TriangleStencil {
 public:
  static constexpr int corners = 3;

  TriangleStencil(const ElementSlabs<3>& slabs, const Shell& shell);
  TriangleRest at(int first) const {
    return {rest_[0].data() + first, rest_[1].data() + first, rest_[2].data() + first,
            rest_[3].data() + first, rest_[4].data() + first};
  }

  /// Lets compressed triangles of these moduli (by element) use masses: Stiffness::bounded. Without it they
  /// use none.
  void use_masses(const ElementSlabs<3>& slabs, const Shell& shell, const std::vector<PlaneModuli>& moduli);
  /// Finds the masses that a batch may use.
  void find_held(int first, int count, std::span<const double> masses,
                 const std::vector<std::array<int, 3>>& vertices, MassBound& bound) const;

  struct LaneModuli {
    double along[2][element_lanes], across[2][element_lanes];  // C₁₁, C₂₂; C₁₂, G
    MUSLIN_INLINE double c11(int l) const { return along[0][l]; }
    MUSLIN_INLINE double c22(int l) const { return along[1][l]; }
    MUSLIN_INLINE double c12(int l) const { return across[0][l]; }
    MUSLIN_INLINE double g(int l) const { return across[1][l]; }
    MUSLIN_INLINE void set(int l, const PlaneModuli& c) {
      along[0][l] = c.c11, along[1][l] = c.c22;
      across[0][l] = c.c12, across[1][l] = c.g;
    }
  };

  /// A stiffness in the frame of the law: turned data only where the law is principal.
  template <class Law>
  struct Stiff : LaneModuli {
    StrainedTriangles strained;
  };
  template <class Law>
    requires(Law::principal)
  struct Stiff<Law> : LaneModuli {
    StrainedTriangles strained;
    double d00[element_lanes], d10[element_lanes], d01[element_lanes], d11[element_lanes];
    TriangleRest turned(const TriangleRest& rest) const { return {d00, d10, d01, d11, rest.area}; }
  };

  template <class Law>
  MUSLIN_VECTOR_CODE static bool energies(const LawLanes<Law>& law, const TriangleRest& rest,
                                          const Batch<3>& x, double* w) {
    LaneVectors a, b;
    along_threads(rest, x, a, b);
    if (!stores_energy(law, a, b)) return false;
    find_energies(law, rest, a, b, w);
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static bool forces(const LawLanes<Law>& law, const TriangleRest& rest, const Batch<3>& x,
                                        Batch<3>& force, double* w) {
    StrainedTriangles s;
    along_threads(rest, x, s.a, s.b);
    if (!stores_energy(law, s.a, s.b)) return false;
    find_stress(law, rest, s);
    find_energies(law, rest, s.a, s.b, w);
    stress_to_corners(rest, s, force);
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static bool stiffen(Stiffness kind, const LawLanes<Law>& law, const TriangleRest& rest,
                                         const MassBound& bound, const Batch<3>& x, Stiff<Law>& out) {
    StrainedTriangles& s = out.strained;
    along_threads(rest, x, s.a, s.b);
    if (!stores_energy(law, s.a, s.b)) return false;
    if constexpr (Law::principal) {
      turn(kind == Stiffness::material, law, rest, out);
    } else {
      find_stress(law, rest, s);
      for (int l = 0; l < element_lanes; ++l)
        out.set(l, Law::moduli(law[l], rest.area[l], metric(s.a, s.b, l)));
      if (kind == Stiffness::bounded) bound_compression(rest, bound.scale, bound.held, s);
      if (kind == Stiffness::projected) cut_compression(s.suu, s.svv, s.suv);
      if (kind == Stiffness::material)
        for (int l = 0; l < element_lanes; ++l) s.suu[l] = s.svv[l] = s.suv[l] = 0;
    }
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static void multiply(const LawLanes<Law>&, const TriangleRest& rest,
                                          const Stiff<Law>& stiff, const Batch<3>& p, Batch<3>& y) {
    stiffness_product(stiff, in_frame(rest, stiff), stiff.strained, p, y);
  }

  template <class Law>
  static void add_corner_block(const LawLanes<Law>&, const TriangleRest& rest, const Stiff<Law>& stiff, int l,
                               int corner, Mat3& block) {
    muslin::add_corner_block(stiff, in_frame(rest, stiff), stiff.strained, l, corner, block);
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static void add_pair_blocks(const LawLanes<Law>&, const TriangleRest& rest,
                                                 const Stiff<Law>& stiff, double scale, int count,
                                                 const unsigned* rows, const ElementSlabs<3>::Slots* slots,
                                                 Float4* blocks) {
    BlockFactors factors;
    find_block_factors(stiff, in_frame(rest, stiff), stiff.strained, scale, factors);
    for (int l = 0; l < count; ++l) add_block_rows(factors, l, rows[l], slots[l], blocks);
  }

 private:
  template <class Law>
  MUSLIN_INLINE static TriangleRest in_frame(const TriangleRest& rest, const Stiff<Law>& stiff) {
    if constexpr (Law::principal) {
      return stiff.turned(rest);
    } else {
      return rest;
    }
  }

  template <class Law>
  MUSLIN_INLINE static bool stores_energy(const LawLanes<Law>& law, const LaneVectors& a,
                                          const LaneVectors& b) {
    if constexpr (requires(Metric m) { Law::excess(law[0], m); }) {
      double excess[element_lanes];
      for (int l = 0; l < element_lanes; ++l) excess[l] = Law::excess(law[l], metric(a, b, l));
      bool any = false;
      for (int l = 0; l < element_lanes; ++l) any |= excess[l] > 0;
      return any;
    }
    return true;
  }

  template <class Law>
  MUSLIN_INLINE static void find_energies(const LawLanes<Law>& law, const TriangleRest& rest,
                                          const LaneVectors& a, const LaneVectors& b, double* w) {
    double energy[element_lanes];
    for (int l = 0; l < element_lanes; ++l) energy[l] = Law::energy(law[l], rest.area[l], metric(a, b, l));
    for (int l = 0; l < element_lanes; ++l) w[l] = energy[l];
  }

  template <class Law>
  MUSLIN_INLINE static void find_stress(const LawLanes<Law>& law, const TriangleRest& rest,
                                        StrainedTriangles& s) {
    for (int l = 0; l < element_lanes; ++l) {
      const PlaneStress stress = Law::stress(law[l], rest.area[l], metric(s.a, s.b, l));
      s.suu[l] = stress.uu;
      s.svv[l] = stress.vv;
      s.suv[l] = stress.uv;
    }
  }

  template <class Law>
  MUSLIN_INLINE static void turn(bool material, const LawLanes<Law>& law, const TriangleRest& rest,
                                 Stiff<Law>& out) {
    StrainedTriangles& s = out.strained;
    for (int l = 0; l < element_lanes; ++l) {
      const PrincipalStiffness p =
          Law::principal_stiffness(law[l], rest.area[l], metric(s.a, s.b, l), material);
      double cosine, sine;
      halve_angle(p.cosine, p.sine, cosine, sine);
      out.d00[l] = cosine * rest.d00[l] + sine * rest.d01[l];
      out.d10[l] = cosine * rest.d10[l] + sine * rest.d11[l];
      out.d01[l] = cosine * rest.d01[l] - sine * rest.d00[l];
      out.d11[l] = cosine * rest.d11[l] - sine * rest.d10[l];
      for (int k = 0; k < 3; ++k) {
        const double a = s.a[k][l], b = s.b[k][l];
        s.a[k][l] = cosine * a + sine * b;
        s.b[k][l] = cosine * b - sine * a;
      }
      out.set(l, p.moduli);
      s.suu[l] = p.stress.uu;
      s.svv[l] = p.stress.vv;
      s.suv[l] = p.stress.uv;
    }
  }

  std::vector<double> rest_[5];  // by entry: inverse rest edges (00, 10, 01, 11) [1/m], area [m²]
  std::vector<std::array<double, 3>> mass_shares_;  // by entry: of the corners' masses
  std::vector<double> stiffness_;                   // by entry: trace of the material blocks at rest [N/m]
};

/// Returns the triangles' corners, as ElementSlabs takes them.
std::vector<std::array<int, 3>> corners_of(const Shell& shell);
std::shared_ptr<const ElementSlabs<3>> triangle_slabs(const Shell& shell);

}  // namespace muslin
