// TetrahedronStencil is a tetrahedron with the deformation gradient F, 3 by 3. Its measure is (I_C, J), the
// trace of FᵀF and the determinant, for isotropic laws of the form
//
//   ψ = a(I_C) + f(J)   [J/m³].
//
// Laws give `energy` ψ in double, and `shear` 2 a', `growth` 4 a'' ≥ 0, `slope` f' and `curvature` f'' in the
// type of the measure, double or float. With g = ∂J/∂F, the cofactors,
//
//   P = 2 a' F + f' g,   dP = 2 a' dF + 4 a'' (F : dF) F + f'' (g : dF) g + f' dg.
//
// The projected stiffness has the eigenvalues of this in closed form. With F = U Σ Vᵀ, σ₃ of the sign of J,
// and dF̂ = Uᵀ dF V, the Hessian falls into one 3 by 3 block of the stretches and three 2 by 2 blocks of
// (dF̂_ij, dF̂_ji),
//
//   A_ij = 2 a' δ_ij + 4 a'' σ_i σ_j + f'' g_i g_j + f' σ_k (i ≠ j),   g_i = σ_j σ_k
//   2 a' − f' σ_k  for dF̂_ij + dF̂_ji,   2 a' + f' σ_k  for dF̂_ij − dF̂_ji
//
// (Smith, de Goes, Kim, Analytic Eigensystems for Isotropic Distortion Energies, 2019); negative ones become
// zero.
//
// The material stiffness resists changes of FᵀF only. With M = dF gᵀ it is
//
//   4 a'' (F : dF)² + b (tr M)² + m |sym M|²,   m = −2 f'/J ≥ 0,  b = f'' + f'/J ≥ −m/3.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/element_slabs.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/energy/principal_axes.hpp"

namespace muslin {

/// Rest data of a batch of tetrahedra: the inverse of the rest edges from corner 0 (as columns), row by row,
/// and the volume.
struct TetrahedronRest {
  std::array<const double*, 9> inverse;
  const double* volume;
};

class TetrahedronStencil {
 public:
  static constexpr int corners = 4;
  using Matrix = LaneMatrix;

  /// `inverses` [1/m] and `volumes` [m³] by element. An entry that all
  /// elements have in common is stored once.
  TetrahedronStencil(const ElementSlabs<4>& slabs, const std::vector<Mat3>& inverses,
                     const std::vector<double>& volumes) {
    for (std::size_t i = 0; i < 9; ++i) {
      const auto row = static_cast<Eigen::Index>(i / 3), column = static_cast<Eigen::Index>(i % 3);
      inverse_[i] =
          LaneArray(slabs.by_entry<double>([&](std::size_t e) { return inverses[e](row, column); }));
    }
    volume_ = LaneArray(slabs.by_entry<double>([&](std::size_t e) { return volumes[e]; }));
  }
  TetrahedronRest at(int first) const {
    TetrahedronRest rest;
    for (std::size_t i = 0; i < 9; ++i) rest.inverse[i] = inverse_[i].at(first);
    rest.volume = volume_.at(first);
    return rest;
  }

  /// Solids use no masses.
  void find_held(int, int, std::span<const double>, const std::vector<std::array<int, 4>>&,
                 MassBound&) const {}

  template <class Law>
  struct Stiff {
    Stiffness kind = Stiffness::projected;
    // F and the multiples of dF, (F : dF) F, (g : dF) g and dg.
    Matrix f;
    double shear[element_lanes], growth[element_lanes], curvature[element_lanes], slope[element_lanes];
    // Material: the corners' gradients of J and of I_C/2, and b and m times the volume.
    // Projected: U, the corners' shape gradients along V, and the stiffness in principal axes times the
    // volume: of dF̂_ii dF̂_jj, of dF̂_ij² and of dF̂_ij dF̂_ji.
    double shape[4][3][element_lanes];
    double half[4][3][element_lanes], bulk[element_lanes], stretching[element_lanes];
    Matrix u;
    Matrix stretch, single, mixed;
  };

  template <class Law>
  MUSLIN_VECTOR_CODE static bool energies(const LawLanes<Law>& law, const TetrahedronRest& rest,
                                          const Batch<4>& x, double* w) {
    Matrix f;
    deformation(rest, x, f);
    double energy[element_lanes];
    for (int l = 0; l < element_lanes; ++l)
      energy[l] = rest.volume[l] * Law::energy(law[l], square(f, l), determinant(f, l));
    for (int l = 0; l < element_lanes; ++l) w[l] = energy[l];
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static bool forces(const LawLanes<Law>& law, const TetrahedronRest& rest,
                                        const Batch<4>& x, Batch<4>& force, double* w) {
    Matrix f, g;
    deformation(rest, x, f);
    cofactors(f, g);
    double energy[element_lanes], shear[element_lanes], slope[element_lanes];
    for (int l = 0; l < element_lanes; ++l) {
      const double j = determinant(f, l);
      const double ic = square(f, l);
      energy[l] = rest.volume[l] * Law::energy(law[l], ic, j);
      shear[l] = rest.volume[l] * Law::shear(law[l], ic);
      slope[l] = rest.volume[l] * Law::slope(law[l], j);
    }
    for (int l = 0; l < element_lanes; ++l) w[l] = energy[l];
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c)
        for (int l = 0; l < element_lanes; ++l) f[k][c][l] = shear[l] * f[k][c][l] + slope[l] * g[k][c][l];
    to_corners(rest, f, force);
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static bool stiffen(Stiffness kind, const LawLanes<Law>& law,
                                         const TetrahedronRest& rest, const MassBound&, const Batch<4>& x,
                                         Stiff<Law>& out) {
    Matrix& f = out.f;
    deformation(rest, x, f);
    for (int l = 0; l < element_lanes; ++l) {
      const double j = determinant(f, l);
      const double ic = square(f, l);
      out.shear[l] = rest.volume[l] * Law::shear(law[l], ic);
      out.growth[l] = rest.volume[l] * Law::growth(law[l], ic);
      out.curvature[l] = rest.volume[l] * Law::curvature(law[l], j);
      out.slope[l] = rest.volume[l] * Law::slope(law[l], j);
    }
    out.kind = kind;
    if (kind == Stiffness::exact) return true;
    double of_corner[4][3][element_lanes];
    shape_gradients(rest, of_corner);
    if (kind == Stiffness::material) {
      resist_strain(of_corner, out);
      return true;
    }
    Matrix v;
    double sigma[3][element_lanes];
    principal_axes(f, out.u, sigma, v);
    for (int c = 0; c < 4; ++c)
      for (int i = 0; i < 3; ++i)
        for (int l = 0; l < element_lanes; ++l)
          out.shape[c][i][l] = v[0][i][l] * of_corner[c][0][l] + v[1][i][l] * of_corner[c][1][l] +
                               v[2][i][l] * of_corner[c][2][l];
    projected_in_axes(sigma, out.shear, out.growth, out.slope, out.curvature, out.stretch, out.single,
                      out.mixed);
    cut_negative(out.stretch);
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static void multiply(const LawLanes<Law>&, const TetrahedronRest& rest,
                                          const Stiff<Law>& stiff, const Batch<4>& p, Batch<4>& y) {
    if (stiff.kind == Stiffness::exact) {
      Matrix d, g, dg;
      deformation(rest, p, d);
      cofactors(stiff.f, g);
      change_of_cofactors(stiff.f, d, dg);
      double along[element_lanes], grown[element_lanes];
      for (int l = 0; l < element_lanes; ++l) {
        double sum = 0, half = 0;
        for (int k = 0; k < 3; ++k)
          for (int c = 0; c < 3; ++c) {
            sum += g[k][c][l] * d[k][c][l];
            half += stiff.f[k][c][l] * d[k][c][l];
          }
        along[l] = stiff.curvature[l] * sum;
        grown[l] = stiff.growth[l] * half;
      }
      for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c)
          for (int l = 0; l < element_lanes; ++l)
            d[k][c][l] = stiff.shear[l] * d[k][c][l] + grown[l] * stiff.f[k][c][l] + along[l] * g[k][c][l] +
                         stiff.slope[l] * dg[k][c][l];
      return to_corners(rest, d, y);
    }
    if (stiff.kind == Stiffness::material) return multiply_strain(stiff, p, y);
    Matrix d, s;  // dF̂ and the stress it makes
    for (int i = 0; i < 3; ++i) {
      double turned[4][element_lanes];
      for (int c = 0; c < 4; ++c)
        for (int l = 0; l < element_lanes; ++l)
          turned[c][l] =
              stiff.u[0][i][l] * p[c][0][l] + stiff.u[1][i][l] * p[c][1][l] + stiff.u[2][i][l] * p[c][2][l];
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < element_lanes; ++l)
          d[i][j][l] = turned[0][l] * stiff.shape[0][j][l] + turned[1][l] * stiff.shape[1][j][l] +
                       turned[2][l] * stiff.shape[2][j][l] + turned[3][l] * stiff.shape[3][j][l];
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < element_lanes; ++l)
          s[i][j][l] = i == j ? stiff.stretch[i][0][l] * d[0][0][l] + stiff.stretch[i][1][l] * d[1][1][l] +
                                    stiff.stretch[i][2][l] * d[2][2][l]
                              : stiff.single[i][j][l] * d[i][j][l] + stiff.mixed[i][j][l] * d[j][i][l];
    for (int c = 0; c < 4; ++c) {
      double turned[3][element_lanes];
      for (int i = 0; i < 3; ++i)
        for (int l = 0; l < element_lanes; ++l)
          turned[i][l] = s[i][0][l] * stiff.shape[c][0][l] + s[i][1][l] * stiff.shape[c][1][l] +
                         s[i][2][l] * stiff.shape[c][2][l];
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < element_lanes; ++l)
          y[c][k][l] = stiff.u[k][0][l] * turned[0][l] + stiff.u[k][1][l] * turned[1][l] +
                       stiff.u[k][2][l] * turned[2][l];
    }
  }

  /// Not of the exact stiffness.
  template <class Law>
  static void add_corner_block(const LawLanes<Law>&, const TetrahedronRest&, const Stiff<Law>& stiff, int l,
                               int corner, Mat3& block) {
    if (stiff.kind == Stiffness::material) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) block(i, j) += strain_entry(stiff, corner, corner, i, j, l);
      return;
    }
    Mat3 inner, u;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        inner(i, j) = entry(stiff, corner, corner, i, j, l);
        u(i, j) = stiff.u[i][j][l];
      }
    block += u * inner * u.transpose();
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static void add_pair_blocks(const LawLanes<Law>&, const TetrahedronRest&,
                                                 const Stiff<Law>& stiff, double scale, int count,
                                                 const unsigned* rows, const ElementSlabs<4>::Slots* slots,
                                                 Float4* blocks) {
    // Blocks of corners c < d; rows of all blocks sum to zero, which gives the diagonal ones.
    float pair[6][3][3][element_lanes], diagonal[4][3][3][element_lanes] = {};
    int n = 0;
    for (int c = 0; c < 4; ++c) {
      for (int d = c + 1; d < 4; ++d, ++n) {
        if (stiff.kind == Stiffness::material) {
          for (int r = 0; r < 3; ++r)
            for (int k = 0; k < 3; ++k)
              for (int l = 0; l < element_lanes; ++l)
                pair[n][r][k][l] = static_cast<float>(scale * strain_entry(stiff, c, d, r, k, l));
          add_to_diagonal(pair[n], diagonal[c], diagonal[d]);
          continue;
        }
        Matrix inner, half;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            for (int l = 0; l < element_lanes; ++l) inner[i][j][l] = scale * entry(stiff, c, d, i, j, l);
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k)
            for (int l = 0; l < element_lanes; ++l)
              half[i][k][l] = inner[i][0][l] * stiff.u[k][0][l] + inner[i][1][l] * stiff.u[k][1][l] +
                              inner[i][2][l] * stiff.u[k][2][l];
        for (int r = 0; r < 3; ++r)
          for (int k = 0; k < 3; ++k)
            for (int l = 0; l < element_lanes; ++l) {
              const double sum = stiff.u[r][0][l] * half[0][k][l] + stiff.u[r][1][l] * half[1][k][l] +
                                 stiff.u[r][2][l] * half[2][k][l];
              pair[n][r][k][l] = static_cast<float>(sum);
            }
        add_to_diagonal(pair[n], diagonal[c], diagonal[d]);
      }
    }
    for (int l = 0; l < count; ++l) {
      const int* slot = slots[l].data();
      n = 0;
      for (int i = 0; i < 4; ++i) {
        for (int j = i; j < 4; ++j, ++slot) {
          const auto& k = i == j ? diagonal[i] : pair[n];
          if (i != j) ++n;
          const bool as_is = *slot >= 0;
          if ((rows[l] >> (as_is ? i : j) & 1U) == 0) continue;
          Float4* const block = blocks + 3 * static_cast<std::ptrdiff_t>(as_is ? *slot : ~*slot);
          if (i == j) {  // of rounded numbers, yet symmetric
            const float xy = 0.5F * (k[0][1][l] + k[1][0][l]), xz = 0.5F * (k[0][2][l] + k[2][0][l]),
                        yz = 0.5F * (k[1][2][l] + k[2][1][l]);
            block[0] += Float4{k[0][0][l], xy, xz, 0};
            block[1] += Float4{xy, k[1][1][l], yz, 0};
            block[2] += Float4{xz, yz, k[2][2][l], 0};
          } else if (as_is) {
            for (int c = 0; c < 3; ++c) block[c] += Float4{k[0][c][l], k[1][c][l], k[2][c][l], 0};
          } else {
            for (int c = 0; c < 3; ++c) block[c] += Float4{k[c][0][l], k[c][1][l], k[c][2][l], 0};
          }
        }
      }
    }
  }

 private:
  MUSLIN_INLINE static void deformation(const TetrahedronRest& rest, const Batch<4>& x, Matrix& f) {
    for (int k = 0; k < 3; ++k) {
      double e[3][element_lanes];
      for (int c = 0; c < 3; ++c)
        for (int l = 0; l < element_lanes; ++l) e[c][l] = x[c + 1][k][l] - x[0][k][l];
      for (std::size_t c = 0; c < 3; ++c)
        for (int l = 0; l < element_lanes; ++l)
          f[k][c][l] = e[0][l] * rest.inverse[c][l] + e[1][l] * rest.inverse[3 + c][l] +
                       e[2][l] * rest.inverse[6 + c][l];
    }
  }
  /// Forces on the corners from a stress times the volume.
  MUSLIN_INLINE static void to_corners(const TetrahedronRest& rest, const Matrix& p, Batch<4>& f) {
    for (int k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c)
        for (int l = 0; l < element_lanes; ++l)
          f[c + 1][k][l] = p[k][0][l] * rest.inverse[3 * c][l] + p[k][1][l] * rest.inverse[3 * c + 1][l] +
                           p[k][2][l] * rest.inverse[3 * c + 2][l];
      for (int l = 0; l < element_lanes; ++l) f[0][k][l] = -(f[1][k][l] + f[2][k][l] + f[3][k][l]);
    }
  }
  MUSLIN_INLINE static void shape_gradients(const TetrahedronRest& rest, double (&b)[4][3][element_lanes]) {
    for (std::size_t i = 0; i < 3; ++i)
      for (int l = 0; l < element_lanes; ++l) {
        b[1][i][l] = rest.inverse[i][l], b[2][i][l] = rest.inverse[3 + i][l];
        b[3][i][l] = rest.inverse[6 + i][l];
        b[0][i][l] = -(b[1][i][l] + b[2][i][l] + b[3][i][l]);
      }
  }
  MUSLIN_INLINE static double square(const Matrix& f, int l) {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) sum += f[k][c][l] * f[k][c][l];
    return sum;
  }
  /// Entry (i, j) of the block of corners c and d along U.
  template <class Law>
  MUSLIN_INLINE static double entry(const Stiff<Law>& s, int c, int d, int i, int j, int l) {
    if (i != j)
      return s.stretch[i][j][l] * s.shape[c][i][l] * s.shape[d][j][l] +
             s.mixed[i][j][l] * s.shape[c][j][l] * s.shape[d][i][l];
    const int p = i == 0 ? 1 : 0, q = i == 2 ? 1 : 2;
    return s.stretch[i][i][l] * s.shape[c][i][l] * s.shape[d][i][l] +
           s.single[i][p][l] * s.shape[c][p][l] * s.shape[d][p][l] +
           s.single[i][q][l] * s.shape[c][q][l] * s.shape[d][q][l];
  }

  using FloatMatrix = float[3][3][element_lanes];
  MUSLIN_INLINE static void add_to_diagonal(const FloatMatrix& pair, FloatMatrix& row, FloatMatrix& column) {
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < element_lanes; ++l) {
          row[r][k][l] -= pair[r][k][l];
          column[r][k][l] -= pair[k][r][l];
        }
  }

  template <class Law>
  MUSLIN_INLINE static void resist_strain(const double (&of_corner)[4][3][element_lanes], Stiff<Law>& out) {
    constexpr double least = 0.01;  // of |J|, as a divisor
    Matrix g;
    cofactors(out.f, g);
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < element_lanes; ++l) {
          out.shape[c][k][l] = g[k][0][l] * of_corner[c][0][l] + g[k][1][l] * of_corner[c][1][l] +
                               g[k][2][l] * of_corner[c][2][l];
          out.half[c][k][l] = out.f[k][0][l] * of_corner[c][0][l] + out.f[k][1][l] * of_corner[c][1][l] +
                              out.f[k][2][l] * of_corner[c][2][l];
        }
    for (int l = 0; l < element_lanes; ++l) {
      const double j = determinant(out.f, l);
      const double divisor = j < 0 ? (j > -least ? -least : j) : (j < least ? least : j);
      const double m = -2 * out.slope[l] / divisor, b = out.curvature[l] + out.slope[l] / divisor;
      out.stretching[l] = m > 0 ? m : 0;
      out.bulk[l] = b > -out.stretching[l] / 3 ? b : -out.stretching[l] / 3;
    }
  }
  /// Forces on the corners, with M = Σ p_d h_dᵀ and h the gradients of J.
  template <class Law>
  MUSLIN_INLINE static void multiply_strain(const Stiff<Law>& s, const Batch<4>& p, Batch<4>& y) {
    Matrix m;
    double grown[element_lanes] = {};
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < element_lanes; ++l) grown[l] += s.growth[l] * s.half[c][k][l] * p[c][k][l];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < element_lanes; ++l)
          m[i][j][l] = p[0][i][l] * s.shape[0][j][l] + p[1][i][l] * s.shape[1][j][l] +
                       p[2][i][l] * s.shape[2][j][l] + p[3][i][l] * s.shape[3][j][l];
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < element_lanes; ++l) {
          const double trace = m[0][0][l] + m[1][1][l] + m[2][2][l];
          double sum = 0;
          for (int j = 0; j < 3; ++j) sum += (m[k][j][l] + m[j][k][l]) * s.shape[c][j][l];
          y[c][k][l] =
              grown[l] * s.half[c][k][l] + s.bulk[l] * trace * s.shape[c][k][l] + 0.5 * s.stretching[l] * sum;
        }
  }
  /// Entry (i, j) of the material block of corners c and d.
  template <class Law>
  MUSLIN_INLINE static double strain_entry(const Stiff<Law>& s, int c, int d, int i, int j, int l) {
    const auto &hc = s.shape[c], &hd = s.shape[d];
    const double even = i == j ? hc[0][l] * hd[0][l] + hc[1][l] * hd[1][l] + hc[2][l] * hd[2][l] : 0;
    return s.growth[l] * s.half[c][i][l] * s.half[d][j][l] + s.bulk[l] * hc[i][l] * hd[j][l] +
           0.5 * s.stretching[l] * (even + hd[i][l] * hc[j][l]);
  }

  MUSLIN_INLINE static void projected_in_axes(const double (&sigma)[3][element_lanes], const double* shear,
                                              const double* growth, const double* slope,
                                              const double* curvature, Matrix& stretch, Matrix& single,
                                              Matrix& mixed) {
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        const int k = 3 - i - j, p = i == 0 ? 1 : 0, q = i == 2 ? 1 : 2;
        for (int l = 0; l < element_lanes; ++l) {
          const double gi = sigma[p][l] * sigma[q][l];
          if (i == j) {
            stretch[i][i][l] = shear[l] + growth[l] * sigma[i][l] * sigma[i][l] + curvature[l] * gi * gi;
            continue;
          }
          const double gj = sigma[i][l] * sigma[k][l], turn = slope[l] * sigma[k][l];
          stretch[i][j][l] = stretch[j][i][l] =
              growth[l] * sigma[i][l] * sigma[j][l] + curvature[l] * gi * gj + turn;
          const double sum = shear[l] - turn > 0 ? shear[l] - turn : 0;
          const double difference = shear[l] + turn > 0 ? shear[l] + turn : 0;
          single[i][j][l] = single[j][i][l] = 0.5 * (sum + difference);
          mixed[i][j][l] = mixed[j][i][l] = 0.5 * (sum - difference);
        }
      }
    }
  }

  std::array<LaneArray, 9> inverse_;
  LaneArray volume_;
};

}  // namespace muslin
