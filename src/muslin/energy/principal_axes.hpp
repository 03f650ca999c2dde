// Computes the principal axes of a batch of 3×3 matrices, in loops over lanes that vectorise.
#pragma once

#include <cmath>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/element_slabs.hpp"

namespace muslin {

/// By row, column and lane.
using LaneMatrix = double[3][3][element_lanes];

MUSLIN_INLINE double determinant(const LaneMatrix& f, int l) {
  return f[0][0][l] * (f[1][1][l] * f[2][2][l] - f[1][2][l] * f[2][1][l]) +
         f[0][1][l] * (f[1][2][l] * f[2][0][l] - f[1][0][l] * f[2][2][l]) +
         f[0][2][l] * (f[1][0][l] * f[2][1][l] - f[1][1][l] * f[2][0][l]);
}

/// g = ∂ det f / ∂f.
MUSLIN_INLINE void cofactors(const LaneMatrix& f, LaneMatrix& g) {
  for (int i = 0; i < 3; ++i) {
    const int p = (i + 1) % 3, q = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int r = (j + 1) % 3, s = (j + 2) % 3;
      for (int l = 0; l < element_lanes; ++l) g[i][j][l] = f[p][r][l] * f[q][s][l] - f[p][s][l] * f[q][r][l];
    }
  }
}
/// The change of g when f changes by d.
MUSLIN_INLINE void change_of_cofactors(const LaneMatrix& f, const LaneMatrix& d, LaneMatrix& dg) {
  for (int i = 0; i < 3; ++i) {
    const int p = (i + 1) % 3, q = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int r = (j + 1) % 3, s = (j + 2) % 3;
      for (int l = 0; l < element_lanes; ++l)
        dg[i][j][l] = d[p][r][l] * f[q][s][l] + f[p][r][l] * d[q][s][l] - d[p][s][l] * f[q][r][l] -
                      f[p][s][l] * d[q][r][l];
    }
  }
}

/// One rotation of Jacobi's method, in the plane of axes p and q.
MUSLIN_INLINE void rotate_axes(int p, int q, LaneMatrix& a, LaneMatrix& v) {
  const int r = 3 - p - q;
  for (int l = 0; l < element_lanes; ++l) {
    const double off = a[p][q][l], difference = a[q][q][l] - a[p][p][l];
    const double size =
        (difference < 0 ? -difference : difference) + std::sqrt(difference * difference + 4 * off * off);
    const double sign = difference < 0 ? -2 : 2;
    const double t = sign * off / (size > 0 ? size : 1);
    const double c = 1 / std::sqrt(1 + t * t), s = t * c;
    a[p][p][l] -= t * off;
    a[q][q][l] += t * off;
    a[p][q][l] = a[q][p][l] = 0;
    const double rp = a[r][p][l], rq = a[r][q][l];
    a[r][p][l] = a[p][r][l] = c * rp - s * rq;
    a[r][q][l] = a[q][r][l] = s * rp + c * rq;
    for (int k = 0; k < 3; ++k) {
      const double vp = v[k][p][l], vq = v[k][q][l];
      v[k][p][l] = c * vp - s * vq;
      v[k][q][l] = s * vp + c * vq;
    }
  }
}
/// Eigenvectors of the symmetric a as columns of v, eigenvalues on its diagonal, by a fixed number of
/// rotations.
MUSLIN_INLINE void symmetric_eigen(LaneMatrix& a, LaneMatrix& v) {
  constexpr int sweeps = 4;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int l = 0; l < element_lanes; ++l) v[i][j][l] = i == j ? 1 : 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    rotate_axes(0, 1, a, v);
    rotate_axes(0, 2, a, v);
    rotate_axes(1, 2, a, v);
  }
}

/// Replaces a symmetric matrix by its positive semidefinite part.
MUSLIN_INLINE void cut_negative(LaneMatrix& a) {
  // Most often no lane has a negative eigenvalue: Sylvester's criterion.
  double worst[element_lanes];
  for (int l = 0; l < element_lanes; ++l) {
    const double minor = a[0][0][l] * a[1][1][l] - a[0][1][l] * a[0][1][l], all = determinant(a, l);
    const double least = a[0][0][l] < minor ? a[0][0][l] : minor;
    worst[l] = least < all ? least : all;
  }
  bool positive = true;
  for (int l = 0; l < element_lanes; ++l) positive = positive && worst[l] > 0;
  if (positive) return;
  LaneMatrix d, v;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int l = 0; l < element_lanes; ++l) d[i][j][l] = a[i][j][l];
  symmetric_eigen(d, v);
  for (int i = 0; i < 3; ++i)
    for (int l = 0; l < element_lanes; ++l) d[i][i][l] = d[i][i][l] < 0 ? -d[i][i][l] : 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      for (int l = 0; l < element_lanes; ++l) {
        const double lacking = v[i][0][l] * d[0][0][l] * v[j][0][l] + v[i][1][l] * d[1][1][l] * v[j][1][l] +
                               v[i][2][l] * d[2][2][l] * v[j][2][l];
        a[i][j][l] = a[j][i][l] = a[i][j][l] + lacking;
      }
}

/// f = u diag(sigma) vᵀ with rotations u and v and sigma₁ ≥ sigma₂ ≥ |sigma₃|; sigma₃ has the sign of det f.
/// Works for matrices of lower rank too.
MUSLIN_INLINE void principal_axes(const LaneMatrix& f, LaneMatrix& u, double (&sigma)[3][element_lanes],
                                  LaneMatrix& v) {
  LaneMatrix a;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int l = 0; l < element_lanes; ++l)
        a[i][j][l] = f[0][i][l] * f[0][j][l] + f[1][i][l] * f[1][j][l] + f[2][i][l] * f[2][j][l];
  symmetric_eigen(a, v);
  constexpr int pairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (const auto& [p, q] : pairs) {
    for (int l = 0; l < element_lanes; ++l) {
      const bool swap = a[p][p][l] < a[q][q][l];
      const double high = swap ? a[q][q][l] : a[p][p][l], low = swap ? a[p][p][l] : a[q][q][l];
      a[p][p][l] = high, a[q][q][l] = low;
      for (int k = 0; k < 3; ++k) {
        const double vp = v[k][p][l], vq = v[k][q][l];
        v[k][p][l] = swap ? vq : vp;
        v[k][q][l] = swap ? vp : vq;
      }
    }
  }
  constexpr double tiny = 1e-12;
  for (int l = 0; l < element_lanes; ++l) {
    v[0][2][l] = v[1][0][l] * v[2][1][l] - v[2][0][l] * v[1][1][l];
    v[1][2][l] = v[2][0][l] * v[0][1][l] - v[0][0][l] * v[2][1][l];
    v[2][2][l] = v[0][0][l] * v[1][1][l] - v[1][0][l] * v[0][1][l];
    double w[3][3];  // f v by column, row
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        w[i][k] = f[k][0][l] * v[0][i][l] + f[k][1][l] * v[1][i][l] + f[k][2][l] * v[2][i][l];
    // The first axis, or x; the second one across it, or any.
    const double first = std::sqrt(w[0][0] * w[0][0] + w[0][1] * w[0][1] + w[0][2] * w[0][2]);
    const bool point = !(first > tiny);
    const double scale = 1 / (point ? 1 : first);
    const double ux = point ? 1 : scale * w[0][0], uy = point ? 0 : scale * w[0][1],
                 uz = point ? 0 : scale * w[0][2];
    const double along = ux * w[1][0] + uy * w[1][1] + uz * w[1][2];
    double px = w[1][0] - along * ux, py = w[1][1] - along * uy, pz = w[1][2] - along * uz;
    const double second = std::sqrt(px * px + py * py + pz * pz);
    const bool line = !(second > tiny);
    const bool steep = ux * ux > 0.5;  // then y is across enough, else x
    const double ax = steep ? 0 : 1, ay = steep ? 1 : 0, of_a = steep ? uy : ux;
    px = line ? ax - of_a * ux : px, py = line ? ay - of_a * uy : py, pz = line ? -of_a * uz : pz;
    const double length = std::sqrt(px * px + py * py + pz * pz);
    px /= length, py /= length, pz /= length;
    const double qx = uy * pz - uz * py, qy = uz * px - ux * pz, qz = ux * py - uy * px;
    u[0][0][l] = ux, u[1][0][l] = uy, u[2][0][l] = uz;
    u[0][1][l] = px, u[1][1][l] = py, u[2][1][l] = pz;
    u[0][2][l] = qx, u[1][2][l] = qy, u[2][2][l] = qz;
    sigma[0][l] = point ? 0 : first;
    sigma[1][l] = line ? 0 : second;
    sigma[2][l] = qx * w[2][0] + qy * w[2][1] + qz * w[2][2];
  }
}

}  // namespace muslin
