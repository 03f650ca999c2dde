// Defines the methods of SolidRows, for the source files that instantiate them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/solid_rows.hpp"

namespace muslin {
namespace solid_rows {

inline constexpr int longest = VoxelPiece::longest;
inline constexpr int multiple = 16;  // of lanes: those beyond the end of a piece are computed and ignored

/// Axes of a path from corner 0 to corner 7, and the sign of their order.
struct Path {
  std::array<int, 3> axes;
  int sign;
};
inline constexpr std::array<Path, 6> paths = {
    {{{0, 1, 2}, 1}, {{1, 2, 0}, 1}, {{2, 0, 1}, 1}, {{1, 0, 2}, -1}, {{0, 2, 1}, -1}, {{2, 1, 0}, -1}}};

/// Edges of a voxel along the axes, by corner and axis.
inline constexpr int along_axes = 12;
struct AxisEdge {
  int from, axis;
};
inline constexpr std::array<AxisEdge, along_axes> axis_edges = {
    {{0, 0}, {2, 0}, {4, 0}, {6, 0}, {0, 1}, {1, 1}, {4, 1}, {5, 1}, {0, 2}, {1, 2}, {2, 2}, {3, 2}}};

/// Edges over the width.
template <class Real>
using Edges = Real[along_axes][3][longest];

template <class Real>
MUSLIN_INLINE const Real (&edge_of(const Edges<Real>& edges, int from, int axis))[3][longest] {
  std::size_t e = 0;
  while (axis_edges[e].from != from || axis_edges[e].axis != axis) ++e;
  return edges[e];
}

MUSLIN_INLINE int padded(int length) { return (length + multiple - 1) / multiple * multiple; }

template <class Real>
MUSLIN_INLINE void load_edges(double width, const VoxelPiece& piece, ConstVectors x, Edges<Real>& edges) {
  double rows[4][3][longest + 1];
  for (int r = 0; r < 4; ++r) {
    const double* const from = x[static_cast<std::size_t>(piece.rows[static_cast<std::size_t>(r)])].data();
    for (int i = 0; i <= piece.length; ++i)
      for (int k = 0; k < 3; ++k) rows[r][k][i] = from[3 * i + k];
  }
  const double per_width = 1 / width;
  const int n = piece.length;
  for (int e = 0; e < along_axes; ++e) {
    const auto [from, axis] = axis_edges[static_cast<std::size_t>(e)];
    const int to = from + (1 << axis);
    for (int k = 0; k < 3; ++k) {
      const double *const a = rows[from / 2][k] + from % 2, *const b = rows[to / 2][k] + to % 2;
      Real* const out = edges[e][k];
      for (int i = 0; i < n; ++i) out[i] = static_cast<Real>(per_width * (b[i] - a[i]));
      for (int i = n; i < padded(n); ++i) out[i] = k == axis ? 1 : 0;  // F = 1, where every law is finite
    }
  }
}

/// F and its cofactors g, by columns along a path, with I_C and J.
template <class Real>
struct Deformation {
  Real e[3][3], g[3][3], ic, j;
};
template <class Real>
MUSLIN_INLINE Deformation<Real> deformation(const Real (*const (&edges)[3])[longest], Real sign, int i) {
  Deformation<Real> d;
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < 3; ++k) d.e[a][k] = edges[a][k][i];
  d.ic = 0;
  for (int a = 0; a < 3; ++a) {
    const Real *const p = d.e[(a + 1) % 3], *const q = d.e[(a + 2) % 3];
    for (int k = 0; k < 3; ++k) {
      const int r = (k + 1) % 3, s = (k + 2) % 3;
      d.g[a][k] = sign * (p[r] * q[s] - p[s] * q[r]);
      d.ic += d.e[a][k] * d.e[a][k];
    }
  }
  d.j = d.e[0][0] * d.g[0][0] + d.e[0][1] * d.g[0][1] + d.e[0][2] * d.g[0][2];
  return d;
}

template <class Real>
MUSLIN_INLINE void edges_of(const Path& path, const Edges<Real>& edges, const Real (*(&of)[3])[longest]) {
  int corner = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    of[a] = edge_of(edges, corner, path.axes[a]);
    corner |= 1 << path.axes[a];
  }
}

/// Laws that provide ψ by parts.
template <class Law>
concept HasLogarithm = requires(const typename Law::Constants& law, double measure) {
  Law::polynomial(law, measure, measure);
  Law::log_factor(law);
  Law::argument(measure);
};

/// Sums ψ of the six tetrahedra of each voxel.
template <class Law>
class Energies {
 public:
  Energies() {
    std::fill_n(sums_, longest, 0.0);
    std::fill_n(arguments_, longest, 1.0);
  }
  /// Adds one tetrahedron of each of n voxels.
  MUSLIN_INLINE void add(const typename Law::Constants& law, const double* ic, const double* j, int n) {
    MUSLIN_INDEPENDENT
    for (int i = 0; i < n; ++i) {
      if constexpr (HasLogarithm<Law>) {
        sums_[i] += Law::polynomial(law, ic[i], j[i]);
        arguments_[i] *= std::min(Law::argument(ic[i]), largest_argument);
      } else {
        sums_[i] += Law::energy(law, ic[i], j[i]);
      }
    }
  }
  double total(const typename Law::Constants& law, const double* volumes, int n) const {
    double total = 0;
    for (int i = 0; i < n; ++i) {
      double sum = sums_[i];
      if constexpr (HasLogarithm<Law>) sum += Law::log_factor(law) * std::log(arguments_[i]);
      total += volumes[i] * sum;
    }
    return total;
  }

 private:
  // The product of six does not overflow. Beyond, the logarithm is nothing beside the polynomial.
  static constexpr double largest_argument = 1e50;

  double sums_[longest], arguments_[longest];
};

using CornerForces = double[8][3][longest];

/// Adds the forces of a tetrahedron from P along its path.
MUSLIN_INLINE void add_to_corners(const double (&p)[3], std::size_t first, std::size_t second, int k, int i,
                                  CornerForces& corners) {
  corners[0][k][i] -= p[0];
  corners[first][k][i] += p[0] - p[1];
  corners[second][k][i] += p[1] - p[2];
  corners[7][k][i] += p[2];
}
MUSLIN_INLINE void add_corners(const CornerForces& corners, int n, RowForces& forces) {
  for (int r = 0; r < 4; ++r) {
    for (int k = 0; k < 3; ++k) {
      const double *const left = corners[2 * r][k], *const right = corners[2 * r + 1][k];
      double* const out = forces[r][k];
      out[0] = left[0];
      for (int i = 1; i < n; ++i) out[i] = left[i] + right[i - 1];
      out[n] = right[n - 1];
    }
  }
}

template <bool with_forces, class Law>
MUSLIN_INLINE void add_tetrahedra(const typename Law::Constants& law, const Edges<double>& edges,
                                  const double* weights, int n, Energies<Law>& energies,
                                  CornerForces& corners) {
  for (const Path& path : paths) {
    const double(*of[3])[longest];
    edges_of(path, edges, of);
    const double sign = path.sign;
    const std::size_t first = std::size_t{1} << path.axes[0], second = first | std::size_t{1} << path.axes[1];
    double ic[longest], j[longest];
    MUSLIN_INDEPENDENT
    for (int i = 0; i < n; ++i) {
      const Deformation<double> d = deformation<double>(of, sign, i);
      ic[i] = d.ic, j[i] = d.j;
      if constexpr (with_forces) {
        const double shear = weights[i] * Law::shear(law, d.ic), slope = weights[i] * Law::slope(law, d.j);
        for (int k = 0; k < 3; ++k) {
          const double p[3] = {shear * d.e[0][k] + slope * d.g[0][k], shear * d.e[1][k] + slope * d.g[1][k],
                               shear * d.e[2][k] + slope * d.g[2][k]};
          add_to_corners(p, first, second, k, i, corners);
        }
      }
    }
    energies.add(law, ic, j, n);
  }
}

template <class Law>
MUSLIN_VECTOR_CODE void sum_energies(const typename Law::Constants& law, double width,
                                     const VoxelPiece& piece, ConstVectors x, Energies<Law>& energies) {
  Edges<double> edges;
  CornerForces none;
  load_edges(width, piece, x, edges);
  add_tetrahedra<false>(law, edges, nullptr, padded(piece.length), energies, none);
}

template <class Law>
MUSLIN_VECTOR_CODE void sum_forces(const typename Law::Constants& law, double width, const VoxelPiece& piece,
                                   const double* volumes, ConstVectors x, Energies<Law>& energies,
                                   RowForces& forces) {
  Edges<double> edges;
  load_edges(width, piece, x, edges);
  const int n = piece.length;
  CornerForces corners = {};
  double weights[longest] = {};
  for (int i = 0; i < n; ++i) weights[i] = volumes[i] / width;
  add_tetrahedra<true>(law, edges, weights, padded(n), energies, corners);
  add_corners(corners, n, forces);
}

/// Coefficients of (tr M)² and |sym M|² in the material stiffness, which together are not negative.
template <class Real>
struct StrainStiffness {
  Real bulk, stretching;
};
template <class Real>
MUSLIN_INLINE StrainStiffness<Real> strain_stiffness(Real curvature, Real slope, Real j) {
  constexpr Real least = static_cast<Real>(0.01);  // of |J|, as a divisor
  const Real divisor = j < 0 ? (j > -least ? -least : j) : (j < least ? least : j);
  const Real m = -2 * slope / divisor, b = curvature + slope / divisor;
  const Real stretching = m > 0 ? m : 0;
  return {b > -stretching / 3 ? b : -stretching / 3, stretching};
}

/// Computes the change of P, times a weight, as F changes by `move` (columns along a path).
template <Stiffness kind, class Law>
MUSLIN_INLINE void change_stress(const typename Law::Constants& law, double weight,
                                 const Deformation<double>& d, double sign, const double (&move)[3][3],
                                 double (&stress)[3][3]) {
  const double slope = weight * Law::slope(law, d.j), curvature = weight * Law::curvature(law, d.j);
  double half = 0, swollen = 0;
  for (int a = 0; a < 3; ++a) {
    for (int k = 0; k < 3; ++k) {
      half += d.e[a][k] * move[a][k];
      swollen += d.g[a][k] * move[a][k];
    }
  }
  const double grown = weight * Law::growth(law, d.ic) * half;
  if constexpr (kind == Stiffness::exact) {
    const double shear = weight * Law::shear(law, d.ic), turn = sign * slope;
    swollen *= curvature;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      for (int k = 0; k < 3; ++k) {
        const int r = (k + 1) % 3, s = (k + 2) % 3;
        const double change =
            move[b][r] * d.e[c][s] - move[b][s] * d.e[c][r] + d.e[b][r] * move[c][s] - d.e[b][s] * move[c][r];
        stress[a][k] = shear * move[a][k] + grown * d.e[a][k] + swollen * d.g[a][k] + turn * change;
      }
    }
  } else {
    const StrainStiffness<double> s = strain_stiffness(curvature, slope, d.j);
    swollen *= s.bulk;
    double m[3][3];
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 3; ++k)
        m[r][k] = move[0][r] * d.g[0][k] + move[1][r] * d.g[1][k] + move[2][r] * d.g[2][k];
    for (int a = 0; a < 3; ++a) {
      for (int k = 0; k < 3; ++k) {
        double sum = 0;
        for (int r = 0; r < 3; ++r) sum += (m[k][r] + m[r][k]) * d.g[a][r];
        stress[a][k] = grown * d.e[a][k] + swollen * d.g[a][k] + 0.5 * s.stretching * sum;
      }
    }
  }
}

template <Stiffness kind, class Law>
MUSLIN_VECTOR_CODE void multiply(const typename Law::Constants& law, double width, const VoxelPiece& piece,
                                 const double* volumes, ConstVectors x, ConstVectors p, RowForces& forces) {
  Edges<double> edges, moves;
  load_edges(width, piece, x, edges);
  load_edges(width, piece, p, moves);
  const int n = piece.length, with_padding = padded(n);
  CornerForces corners = {};
  double weights[longest] = {};
  for (int i = 0; i < n; ++i) weights[i] = volumes[i] / width;
  for (const Path& path : paths) {
    const double(*of[3])[longest], (*along[3])[longest];
    edges_of(path, edges, of);
    edges_of(path, moves, along);
    const double sign = path.sign;
    const std::size_t first = std::size_t{1} << path.axes[0], second = first | std::size_t{1} << path.axes[1];
    MUSLIN_INDEPENDENT
    for (int i = 0; i < with_padding; ++i) {
      double move[3][3], stress[3][3];
      for (int a = 0; a < 3; ++a)
        for (int k = 0; k < 3; ++k) move[a][k] = along[a][k][i];
      change_stress<kind, Law>(law, weights[i], deformation<double>(of, sign, i), sign, move, stress);
      for (int k = 0; k < 3; ++k) {
        const double of_axis[3] = {stress[0][k], stress[1][k], stress[2][k]};
        add_to_corners(of_axis, first, second, k, i, corners);
      }
    }
  }
  add_corners(corners, n, forces);
}

inline constexpr int block_stride = VoxelPiece::longest + 16;

/// Returns the blocks of an edge of a voxel: those of its row of vertices, the next ones if it begins at the
/// far end along x.
MUSLIN_INLINE float* blocks_of(RowBlocks& blocks, int from, int to) {
  std::size_t e = 0;
  while (row_edges[e].row != from / 2 || row_edges[e].along != to - from) ++e;
  return blocks[e][0] + from % 2;
}

template <Stiffness kind, class Law>
MUSLIN_INLINE void add_blocks(const typename Law::Constants& law, const float* factors,
                              const Edges<float>& edges, const Path& path, int n, RowBlocks& blocks) {
  const float(*of[3])[longest];
  edges_of(path, edges, of);
  const auto sign = static_cast<float>(path.sign);
  const int first = 1 << path.axes[0], second = first | 1 << path.axes[1];
  float *const b01 = blocks_of(blocks, 0, first), *const b02 = blocks_of(blocks, 0, second),
               *const b03 = blocks_of(blocks, 0, 7), *const b12 = blocks_of(blocks, first, second),
               *const b13 = blocks_of(blocks, first, 7), *const b23 = blocks_of(blocks, second, 7);
  MUSLIN_INDEPENDENT
  for (int i = 0; i < n; ++i) {
    const Deformation<float> d = deformation<float>(of, sign, i);
    const float slope = factors[i] * Law::slope(law, d.j), growth = factors[i] * Law::growth(law, d.ic);
    float bulk = factors[i] * Law::curvature(law, d.j), stretching = 0;
    if constexpr (kind == Stiffness::material) {
      const StrainStiffness<float> strain = strain_stiffness(bulk, slope, d.j);
      bulk = strain.bulk, stretching = strain.stretching;
    }
    // Gradients of I_C/2 and J by the corners, times the width.
    float h[4][3], q[4][3], grown[4][3], swollen[4][3];
    for (int k = 0; k < 3; ++k) {
      h[0][k] = -d.e[0][k], h[1][k] = d.e[0][k] - d.e[1][k], h[2][k] = d.e[1][k] - d.e[2][k],
      h[3][k] = d.e[2][k];
      q[0][k] = -d.g[0][k], q[1][k] = d.g[0][k] - d.g[1][k], q[2][k] = d.g[1][k] - d.g[2][k],
      q[3][k] = d.g[2][k];
      for (int c = 1; c < 4; ++c) grown[c][k] = growth * h[c][k], swollen[c][k] = bulk * q[c][k];
    }
    const float shear = kind == Stiffness::exact ? factors[i] * Law::shear(law, d.ic) : 0.5F * stretching;
    const float turn = sign * slope;
    // ∂²J/∂x_c ∂x_e is the cross product with (x, y, z), the edge opposite to c and e.
    const auto add = [&](float* to, int c, int e, bool along_axis, float x, float y, float z) {
      float block[3][3];
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) block[r][k] = h[c][r] * grown[e][k] + q[c][r] * swollen[e][k];
      if constexpr (kind == Stiffness::exact) {
        block[0][1] -= turn * z, block[0][2] += turn * y, block[1][2] -= turn * x;
        block[1][0] += turn * z, block[2][0] -= turn * y, block[2][1] += turn * x;
        if (along_axis)
          for (int k = 0; k < 3; ++k) block[k][k] -= shear;
      } else {
        const float even = q[c][0] * q[e][0] + q[c][1] * q[e][1] + q[c][2] * q[e][2];
        for (int r = 0; r < 3; ++r) {
          for (int k = 0; k < 3; ++k) block[r][k] += shear * q[e][r] * q[c][k];
          block[r][r] += shear * even;
        }
      }
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) to[(3 * r + k) * block_stride + i] += block[r][k];
    };
    const auto& e = d.e;
    add(b01, 0, 1, true, -e[2][0], -e[2][1], -e[2][2]);
    add(b02, 0, 2, false, e[1][0] + e[2][0], e[1][1] + e[2][1], e[1][2] + e[2][2]);
    add(b03, 0, 3, false, -e[1][0], -e[1][1], -e[1][2]);
    add(b12, 1, 2, true, -(e[0][0] + e[1][0] + e[2][0]), -(e[0][1] + e[1][1] + e[2][1]),
        -(e[0][2] + e[1][2] + e[2][2]));
    add(b13, 1, 3, false, e[0][0] + e[1][0], e[0][1] + e[1][1], e[0][2] + e[1][2]);
    add(b23, 2, 3, true, -e[0][0], -e[0][1], -e[0][2]);
  }
}

template <Stiffness kind, class Law>
MUSLIN_VECTOR_CODE void find_blocks(const typename Law::Constants& law, double width, const VoxelPiece& piece,
                                    const double* volumes, double factor, ConstVectors x, RowBlocks& blocks) {
  Edges<float> edges;
  load_edges(width, piece, x, edges);
  float factors[longest] = {};
  for (int i = 0; i < piece.length; ++i)
    factors[i] = static_cast<float>(factor * volumes[i] / (width * width));
  std::memset(blocks, 0, sizeof(RowBlocks));
  for (const Path& path : paths)
    add_blocks<kind, Law>(law, factors, edges, path, padded(piece.length), blocks);
}

}  // namespace solid_rows

template <class Law>
SolidRows<Law>::SolidRows(const Lattice& lattice, const typename Law::Constants& law,
                          const SymmetricPattern* pattern)
    : law_(law), width_(lattice.width), rows_(lattice) {
  for (const double fill : lattice.fill)
    volumes_.push_back(fill * lattice.width * lattice.width * lattice.width / 6);
  if (pattern) slots_ = RowSlots(rows_, *pattern);
}

template <class Law>
double SolidRows<Law>::value(ConstVectors x) const {
  return rows_.sum([&](const VoxelPiece& piece) {
    solid_rows::Energies<Law> energies;
    solid_rows::sum_energies<Law>(law_, width_, piece, x, energies);
    return energies.total(law_, volumes(piece), piece.length);
  });
}

template <class Law>
double SolidRows<Law>::add_gradient_and_value(ConstVectors x, Vectors g) const {
  return rows_.sum([&](const VoxelPiece& piece) {
    solid_rows::Energies<Law> energies;
    RowForces forces;
    solid_rows::sum_forces<Law>(law_, width_, piece, volumes(piece), x, energies, forces);
    add_to_vertices(forces, piece, g);
    return energies.total(law_, volumes(piece), piece.length);
  });
}

template <class Law>
void SolidRows<Law>::add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const {
  const auto multiply = kind == Stiffness::exact ? solid_rows::multiply<Stiffness::exact, Law>
                                                 : solid_rows::multiply<Stiffness::material, Law>;
  rows_.for_each([&](const VoxelPiece& piece) {
    RowForces forces;
    multiply(law_, width_, piece, volumes(piece), x, p, forces);
    add_to_vertices(forces, piece, y);
  });
}

template <class Law>
void SolidRows<Law>::add_pair_blocks(Stiffness kind, ConstVectors x, double factor, bool fresh,
                                     PairBlocks to) const {
  const auto find_blocks = kind == Stiffness::exact ? solid_rows::find_blocks<Stiffness::exact, Law>
                                                    : solid_rows::find_blocks<Stiffness::material, Law>;
  rows_.for_each([&](const VoxelPiece& piece) {
    RowBlocks blocks;
    find_blocks(law_, width_, piece, volumes(piece), factor, x, blocks);
    slots_.add(blocks, piece, fresh, to);
  });
}

}  // namespace muslin
