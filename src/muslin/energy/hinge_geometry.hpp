// The angle θ between the normals of two triangles that share an edge, and its derivatives, over the lanes of
// a batch of hinges. Vertices 0 and 1 are the edge, 2 and 3 the wings. A triangle without area has no bending
// direction: the gradient of the angle is zero there. Derivation: docs/theory/shells.md.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "muslin/core/arc_tangent.hpp"
#include "muslin/core/float4.hpp"
#include "muslin/core/vector_code.hpp"
#include "muslin/energy/element_slabs.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

using LaneVector = double[3][element_lanes];

MUSLIN_INLINE void subtract_lanes(const LaneVector& p, const LaneVector& q, LaneVector& out) {
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < element_lanes; ++l) out[k][l] = p[k][l] - q[k][l];
}
MUSLIN_INLINE void cross_lanes(const LaneVector& p, const LaneVector& q, LaneVector& out) {
  for (int l = 0; l < element_lanes; ++l) {
    out[0][l] = p[1][l] * q[2][l] - p[2][l] * q[1][l];
    out[1][l] = p[2][l] * q[0][l] - p[0][l] * q[2][l];
    out[2][l] = p[0][l] * q[1][l] - p[1][l] * q[0][l];
  }
}
MUSLIN_INLINE double dot_lanes(const LaneVector& p, const LaneVector& q, int l) {
  return p[0][l] * q[0][l] + p[1][l] * q[1][l] + p[2][l] * q[2][l];
}

/// A hinge and the gradient of its angle: −u on the wings, balanced by the gradient at the edge's ends.
struct BentHinge {
  LaneVector e, f, g;  // edge and wings from vertex 0
  LaneVector n1, n2;   // twice the triangles' areas along their normals
  double e2[element_lanes], q1[element_lanes],
      q2[element_lanes];                              // e², 1/n₁², 1/n₂², the latter 0 without area
  double sine[element_lanes], cosine[element_lanes];  // of θ, times a common factor
};

MUSLIN_INLINE void bend_hinge(const Batch<4>& x, BentHinge& h) {
  subtract_lanes(x[1], x[0], h.e);
  subtract_lanes(x[2], x[0], h.f);
  subtract_lanes(x[3], x[0], h.g);
  cross_lanes(h.e, h.f, h.n1);
  cross_lanes(h.g, h.e, h.n2);
  LaneVector across;
  cross_lanes(h.n1, h.n2, across);
  for (int l = 0; l < element_lanes; ++l) {
    h.e2[l] = dot_lanes(h.e, h.e, l);
    // Sines of the wings' angles below 1e-10 are rounding error.
    const double n1 = dot_lanes(h.n1, h.n1, l), n2 = dot_lanes(h.n2, h.n2, l);
    const double f2 = dot_lanes(h.f, h.f, l), g2 = dot_lanes(h.g, h.g, l);
    h.q1[l] = n1 > 1e-20 * h.e2[l] * f2 ? 1 / n1 : 0;
    h.q2[l] = n2 > 1e-20 * h.e2[l] * g2 ? 1 / n2 : 0;
    h.sine[l] = dot_lanes(across, h.e, l);
    h.cosine[l] = dot_lanes(h.n1, h.n2, l) * std::sqrt(h.e2[l]);
  }
}

struct AngleGradient {
  LaneVector u1, u2;
  double length[element_lanes], t1[element_lanes],
      t2[element_lanes];  // of the edge; positions of the wings' feet along it
};

MUSLIN_INLINE void gradient_of_angle(const BentHinge& h, AngleGradient& d) {
  for (int l = 0; l < element_lanes; ++l) {
    d.length[l] = std::sqrt(h.e2[l]);
    const double per_edge = h.e2[l] > 0 ? 1 / h.e2[l] : 0;
    d.t1[l] = dot_lanes(h.f, h.e, l) * per_edge;
    d.t2[l] = dot_lanes(h.g, h.e, l) * per_edge;
  }
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < element_lanes; ++l) {
      d.u1[k][l] = d.length[l] * h.q1[l] * h.n1[k][l];
      d.u2[k][l] = d.length[l] * h.q2[l] * h.n2[k][l];
    }
  }
}

MUSLIN_INLINE void angle_to_corners(const AngleGradient& d, Batch<4>& g) {
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < element_lanes; ++l) {
      g[0][k][l] = (1 - d.t1[l]) * d.u1[k][l] + (1 - d.t2[l]) * d.u2[k][l];
      g[1][k][l] = d.t1[l] * d.u1[k][l] + d.t2[l] * d.u2[k][l];
      g[2][k][l] = -d.u1[k][l];
      g[3][k][l] = -d.u2[k][l];
    }
  }
}

/// Computes the change of the gradient of θ when the corners move by p, by differentiating gradient_of_angle
/// term by term.
MUSLIN_INLINE void change_of_angle_gradient(const BentHinge& h, const AngleGradient& d, const Batch<4>& p,
                                            Batch<4>& change) {
  LaneVector de, df, dg, part, dn1, dn2;
  subtract_lanes(p[1], p[0], de);
  subtract_lanes(p[2], p[0], df);
  subtract_lanes(p[3], p[0], dg);
  cross_lanes(de, h.f, dn1);
  cross_lanes(h.e, df, part);
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < element_lanes; ++l) dn1[k][l] += part[k][l];
  cross_lanes(dg, h.e, dn2);
  cross_lanes(h.g, de, part);
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < element_lanes; ++l) dn2[k][l] += part[k][l];

  for (int l = 0; l < element_lanes; ++l) {
    const double per_edge = h.e2[l] > 0 ? 1 / h.e2[l] : 0;
    const double ede = dot_lanes(h.e, de, l);
    const double dlength = ede * per_edge * d.length[l];
    const double dt1 = (dot_lanes(df, h.e, l) + dot_lanes(h.f, de, l) - 2 * d.t1[l] * ede) * per_edge;
    const double dt2 = (dot_lanes(dg, h.e, l) + dot_lanes(h.g, de, l) - 2 * d.t2[l] * ede) * per_edge;
    const double s1 = h.q1[l] * (dlength - 2 * d.length[l] * h.q1[l] * dot_lanes(h.n1, dn1, l));
    const double s2 = h.q2[l] * (dlength - 2 * d.length[l] * h.q2[l] * dot_lanes(h.n2, dn2, l));
    for (int k = 0; k < 3; ++k) {
      const double du1 = s1 * h.n1[k][l] + d.length[l] * h.q1[l] * dn1[k][l];
      const double du2 = s2 * h.n2[k][l] + d.length[l] * h.q2[l] * dn2[k][l];
      change[0][k][l] = (1 - d.t1[l]) * du1 + (1 - d.t2[l]) * du2 - dt1 * d.u1[k][l] - dt2 * d.u2[k][l];
      change[1][k][l] = d.t1[l] * du1 + d.t2[l] * du2 + dt1 * d.u1[k][l] + dt2 * d.u2[k][l];
      change[2][k][l] = -du1;
      change[3][k][l] = -du2;
    }
  }
}

/// Adds scale · curvature ∇θ∇θᵀ to blocks in float, for rows of corners with a bit in `rows`.
MUSLIN_VECTOR_CODE inline void add_angle_squares(const double* curvature, const Batch<4>& gradient,
                                                 double scale, int count, const unsigned* rows,
                                                 const ElementSlabs<4>::Slots* slots, Float4* blocks) {
  float d[4][3][element_lanes];
  for (int l = 0; l < element_lanes; ++l) {
    const double root = std::sqrt(scale * curvature[l]);
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k) d[c][k][l] = static_cast<float>(root * gradient[c][k][l]);
  }
  for (int l = 0; l < count; ++l) {
    Float4 of_corner[4];
    for (int c = 0; c < 4; ++c) of_corner[c] = Float4{d[c][0][l], d[c][1][l], d[c][2][l], 0};
    const int* slot = slots[l].data();
    for (int i = 0; i < 4; ++i) {
      for (int j = i; j < 4; ++j, ++slot) {
        const int row = *slot >= 0 ? i : j, column = *slot >= 0 ? j : i;
        if ((rows[l] >> row & 1U) == 0) continue;
        Float4* const block = blocks + 3 * static_cast<std::ptrdiff_t>(*slot >= 0 ? *slot : ~*slot);
        for (int k = 0; k < 3; ++k) block[k] += of_corner[column][k] * of_corner[row];
      }
    }
  }
}

/// Computes w = θ − θ₀ within −π … π.
MUSLIN_INLINE void find_deviations(const BentHinge& h, const double* rest, double* out) {
  constexpr double turn = 2 * std::numbers::pi;
  for (int l = 0; l < element_lanes; ++l) {
    const double difference = arc_tangent(h.sine[l], h.cosine[l]) - rest[l];
    out[l] = difference - (difference > turn / 2 ? turn : 0) + (difference < -turn / 2 ? turn : 0);
  }
}

/// Returns the hinges' vertices, as ElementSlabs takes them.
inline std::vector<std::array<int, 4>> hinge_vertices(const Shell& shell) {
  std::vector<std::array<int, 4>> vertices;
  vertices.reserve(shell.hinges.size());
  for (const Hinge& hinge : shell.hinges) vertices.push_back(hinge.vertices);
  return vertices;
}

}  // namespace muslin
