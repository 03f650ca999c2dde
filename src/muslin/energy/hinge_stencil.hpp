// HingeStencil is an edge between two triangles, with the angle θ between their normals. Its measure is the
// deviation w = θ − θ₀ from the angle at rest, within −π … π. Laws give, with the weight of the element in
// their constants,
//
//   energy       ψ(w) [J]
//   moment       ψ'(w) [N·m]
//   curvature    ψ''(w) [N·m], with `linear` for any w
//
// and the stiffness is ψ'' ∇θ∇θᵀ + ψ' ∇²θ; projected it is the first term, without a negative ψ''. For the
// gradient of θ see docs/theory/shells.md. A triangle without area has no bending direction and exerts no
// force. Vertices 0 and 1 are the edge, 2 and 3 the wings.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "muslin/core/arc_tangent.hpp"
#include "muslin/core/vector_code.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/element_slabs.hpp"
#include "muslin/energy/law.hpp"
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

class HingeStencil {
 public:
  static constexpr int corners = 4;

  HingeStencil(const ElementSlabs<4>& slabs, const Shell& shell)
      : rest_(slabs.by_entry<double>([&](std::size_t e) { return shell.hinges[e].angle; })) {}
  /// θ₀ of a batch.
  const double* at(int first) const { return rest_.data() + first; }

  /// Bending uses no masses.
  void find_held(int, int, std::span<const double>, const std::vector<std::array<int, 4>>&,
                 MassBound&) const {}

  template <class Law>
  struct Stiff {
    Batch<4> gradient;  // ∇θ
    double curvature[element_lanes];
    // For the exact stiffness.
    bool exact = false;
    BentHinge hinge;
    AngleGradient angle;
    double moment[element_lanes];
  };

  template <class Law>
  MUSLIN_VECTOR_CODE static bool energies(const LawLanes<Law>& law, const double* rest, const Batch<4>& x,
                                          double* w) {
    BentHinge h;
    bend_hinge(x, h);
    double deviation[element_lanes], energy[element_lanes];
    find_deviations(h, rest, deviation);
    for (int l = 0; l < element_lanes; ++l) energy[l] = Law::energy(law[l], deviation[l]);
    for (int l = 0; l < element_lanes; ++l) w[l] = energy[l];
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static bool forces(const LawLanes<Law>& law, const double* rest, const Batch<4>& x,
                                        Batch<4>& force, double* w) {
    BentHinge h;
    AngleGradient d;
    bend_hinge(x, h);
    gradient_of_angle(h, d);
    angle_to_corners(d, force);
    double deviation[element_lanes], moment[element_lanes], energy[element_lanes];
    find_deviations(h, rest, deviation);
    for (int l = 0; l < element_lanes; ++l) {
      energy[l] = Law::energy(law[l], deviation[l]);
      moment[l] = Law::moment(law[l], deviation[l]);
    }
    for (int l = 0; l < element_lanes; ++l) w[l] = energy[l];
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < element_lanes; ++l) force[c][k][l] *= moment[l];
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static bool stiffen(Stiffness kind, const LawLanes<Law>& law, const double* rest,
                                         const MassBound&, const Batch<4>& x, Stiff<Law>& out) {
    BentHinge& h = out.hinge;
    bend_hinge(x, h);
    gradient_of_angle(h, out.angle);
    angle_to_corners(out.angle, out.gradient);
    out.exact = kind == Stiffness::exact;
    double deviation[element_lanes] = {};
    if (!Law::linear || out.exact) find_deviations(h, rest, deviation);
    for (int l = 0; l < element_lanes; ++l) {
      const double curvature = Law::curvature(law[l], deviation[l]);
      out.curvature[l] = curvature > 0 || out.exact ? curvature : 0;
    }
    if (out.exact)
      for (int l = 0; l < element_lanes; ++l) out.moment[l] = Law::moment(law[l], deviation[l]);
    return true;
  }

  template <class Law>
  MUSLIN_VECTOR_CODE static void multiply(const LawLanes<Law>&, const double*, const Stiff<Law>& stiff,
                                          const Batch<4>& p, Batch<4>& y) {
    const Batch<4>& g = stiff.gradient;
    double along[element_lanes];
    for (int l = 0; l < element_lanes; ++l)
      along[l] = stiff.curvature[l] * (dot_lanes(g[0], p[0], l) + dot_lanes(g[1], p[1], l) +
                                       dot_lanes(g[2], p[2], l) + dot_lanes(g[3], p[3], l));
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < element_lanes; ++l) y[c][k][l] = along[l] * g[c][k][l];
    if (!stiff.exact) return;
    Batch<4> change;
    change_of_angle_gradient(stiff.hinge, stiff.angle, p, change);
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < element_lanes; ++l) y[c][k][l] += stiff.moment[l] * change[c][k][l];
  }

  template <class Law>
  static void add_corner_block(const LawLanes<Law>&, const double*, const Stiff<Law>& stiff, int l,
                               int corner, Mat3& block) {
    const auto& g = stiff.gradient[corner];
    const Vec3 d(g[0][l], g[1][l], g[2][l]);
    block += stiff.curvature[l] * d * d.transpose();
  }

  /// For rows of corners with a bit in `rows`.
  template <class Law>
  static void add_pair_blocks(const LawLanes<Law>&, const double*, const Stiff<Law>& stiff, double scale,
                              int count, const unsigned* rows, const ElementSlabs<4>::Slots* slots,
                              Float4* blocks) {
    add_squares(stiff.curvature, stiff.gradient, scale, count, rows, slots, blocks);
  }

  /// Adds scale · curvature ∇θ∇θᵀ, likewise.
  MUSLIN_VECTOR_CODE static void add_squares(const double* curvature, const Batch<4>& gradient, double scale,
                                             int count, const unsigned* rows,
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

  /// θ − θ₀ within −π … π.
  MUSLIN_INLINE static void find_deviations(const BentHinge& h, const double* rest, double* out) {
    constexpr double turn = 2 * std::numbers::pi;
    for (int l = 0; l < element_lanes; ++l) {
      const double difference = arc_tangent(h.sine[l], h.cosine[l]) - rest[l];
      out[l] = difference - (difference > turn / 2 ? turn : 0) + (difference < -turn / 2 ? turn : 0);
    }
  }

 private:
  std::vector<double> rest_;  // by entry: θ₀
};

/// Returns the hinges' vertices, as ElementSlabs takes them.
inline std::vector<std::array<int, 4>> hinge_vertices(const Shell& shell) {
  std::vector<std::array<int, 4>> vertices;
  for (const Hinge& hinge : shell.hinges) vertices.push_back(hinge.vertices);
  return vertices;
}

}  // namespace muslin
