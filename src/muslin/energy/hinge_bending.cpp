#include "muslin/energy/hinge_bending.hpp"

#include <cmath>
#include <numbers>

#include "muslin/core/arc_tangent.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int lanes = element_lanes;
constexpr double turn = 2 * std::numbers::pi;

using Vector = double[3][lanes];

MUSLIN_INLINE void subtract(const Vector& p, const Vector& q, Vector& out) {
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < lanes; ++l) out[k][l] = p[k][l] - q[k][l];
}
MUSLIN_INLINE void cross(const Vector& p, const Vector& q, Vector& out) {
  for (int l = 0; l < lanes; ++l) {
    out[0][l] = p[1][l] * q[2][l] - p[2][l] * q[1][l];
    out[1][l] = p[2][l] * q[0][l] - p[0][l] * q[2][l];
    out[2][l] = p[0][l] * q[1][l] - p[1][l] * q[0][l];
  }
}
MUSLIN_INLINE double dot(const Vector& p, const Vector& q, int l) {
  return p[0][l] * q[0][l] + p[1][l] * q[1][l] + p[2][l] * q[2][l];
}

/// A hinge and the gradient of its angle: −u on the wings, balanced by that on the edge's ends.
struct Bent {
  Vector e, f, g;                          // edge and wings from vertex 0
  Vector n1, n2;                           // twice the triangles' areas along their normals
  double e2[lanes], q1[lanes], q2[lanes];  // e², 1/n₁², 1/n₂², the latter 0 without area
  double sine[lanes], cosine[lanes];       // of θ, times a common factor
};

MUSLIN_INLINE void bend(const Batch<4>& x, Bent& h) {
  subtract(x[1], x[0], h.e);
  subtract(x[2], x[0], h.f);
  subtract(x[3], x[0], h.g);
  cross(h.e, h.f, h.n1);
  cross(h.g, h.e, h.n2);
  Vector across;
  cross(h.n1, h.n2, across);
  for (int l = 0; l < lanes; ++l) {
    h.e2[l] = dot(h.e, h.e, l);
    // Sines of the wings' angles below 1e-10 are rounding error.
    const double n1 = dot(h.n1, h.n1, l), n2 = dot(h.n2, h.n2, l);
    const double f2 = dot(h.f, h.f, l), g2 = dot(h.g, h.g, l);
    h.q1[l] = n1 > 1e-20 * h.e2[l] * f2 ? 1 / n1 : 0;
    h.q2[l] = n2 > 1e-20 * h.e2[l] * g2 ? 1 / n2 : 0;
    h.sine[l] = dot(across, h.e, l);
    h.cosine[l] = dot(h.n1, h.n2, l) * std::sqrt(h.e2[l]);
  }
}

struct Gradient {
  Vector u1, u2;
  double length[lanes], t1[lanes], t2[lanes];  // of the edge; positions of the wings' feet along it
};

MUSLIN_INLINE void gradient_of_angle(const Bent& h, Gradient& d) {
  for (int l = 0; l < lanes; ++l) {
    d.length[l] = std::sqrt(h.e2[l]);
    const double per_edge = h.e2[l] > 0 ? 1 / h.e2[l] : 0;
    d.t1[l] = dot(h.f, h.e, l) * per_edge;
    d.t2[l] = dot(h.g, h.e, l) * per_edge;
  }
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < lanes; ++l) {
      d.u1[k][l] = d.length[l] * h.q1[l] * h.n1[k][l];
      d.u2[k][l] = d.length[l] * h.q2[l] * h.n2[k][l];
    }
  }
}

MUSLIN_INLINE void to_corners(const Gradient& d, Batch<4>& g) {
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < lanes; ++l) {
      g[0][k][l] = (1 - d.t1[l]) * d.u1[k][l] + (1 - d.t2[l]) * d.u2[k][l];
      g[1][k][l] = d.t1[l] * d.u1[k][l] + d.t2[l] * d.u2[k][l];
      g[2][k][l] = -d.u1[k][l];
      g[3][k][l] = -d.u2[k][l];
    }
  }
}

/// Returns θ − θ₀ within −π … π.
MUSLIN_INLINE void deviations(const Bent& h, const double* rest, double* out) {
  for (int l = 0; l < lanes; ++l) {
    const double difference = arc_tangent(h.sine[l], h.cosine[l]) - rest[l];
    out[l] = difference - (difference > turn / 2 ? turn : 0) + (difference < -turn / 2 ? turn : 0);
  }
}

MUSLIN_VECTOR_CODE void energies(const double* stiffness, const double* rest, const Batch<4>& x, double* w) {
  Bent h;
  bend(x, h);
  double deviation[lanes];
  deviations(h, rest, deviation);
  for (int l = 0; l < lanes; ++l) w[l] = 0.5 * stiffness[l] * deviation[l] * deviation[l];
}

/// Computes the forces on the corners, and W.
MUSLIN_VECTOR_CODE void gradients(const double* stiffness, const double* rest, const Batch<4>& x,
                                  Batch<4>& force, double* w) {
  Bent h;
  Gradient d;
  bend(x, h);
  gradient_of_angle(h, d);
  to_corners(d, force);
  double moment[lanes];
  deviations(h, rest, moment);
  for (int l = 0; l < lanes; ++l) {
    w[l] = 0.5 * stiffness[l] * moment[l] * moment[l];
    moment[l] *= stiffness[l];
  }
  for (int c = 0; c < 4; ++c)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < lanes; ++l) force[c][k][l] *= moment[l];
}

MUSLIN_VECTOR_CODE void angle_gradients(const Batch<4>& x, Batch<4>& g) {
  Bent h;
  Gradient d;
  bend(x, h);
  gradient_of_angle(h, d);
  to_corners(d, g);
}

/// Computes the change of the gradient of θ when the corners move by p, by differentiating gradient_of_angle
/// term by term.
MUSLIN_INLINE void change_of_gradient(const Bent& h, const Gradient& d, const Batch<4>& p, Batch<4>& change) {
  Vector de, df, dg, part, dn1, dn2;
  subtract(p[1], p[0], de);
  subtract(p[2], p[0], df);
  subtract(p[3], p[0], dg);
  cross(de, h.f, dn1);
  cross(h.e, df, part);
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < lanes; ++l) dn1[k][l] += part[k][l];
  cross(dg, h.e, dn2);
  cross(h.g, de, part);
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < lanes; ++l) dn2[k][l] += part[k][l];

  for (int l = 0; l < lanes; ++l) {
    const double per_edge = h.e2[l] > 0 ? 1 / h.e2[l] : 0;
    const double ede = dot(h.e, de, l);
    const double dlength = ede * per_edge * d.length[l];
    const double dt1 = (dot(df, h.e, l) + dot(h.f, de, l) - 2 * d.t1[l] * ede) * per_edge;
    const double dt2 = (dot(dg, h.e, l) + dot(h.g, de, l) - 2 * d.t2[l] * ede) * per_edge;
    const double s1 = h.q1[l] * (dlength - 2 * d.length[l] * h.q1[l] * dot(h.n1, dn1, l));
    const double s2 = h.q2[l] * (dlength - 2 * d.length[l] * h.q2[l] * dot(h.n2, dn2, l));
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

MUSLIN_VECTOR_CODE void products(Stiffness kind, const double* stiffness, const double* rest,
                                 const Batch<4>& x, const Batch<4>& p, Batch<4>& y) {
  Bent h;
  Gradient d;
  Batch<4> g;
  bend(x, h);
  gradient_of_angle(h, d);
  to_corners(d, g);
  double along[lanes];
  for (int l = 0; l < lanes; ++l)
    along[l] =
        stiffness[l] * (dot(g[0], p[0], l) + dot(g[1], p[1], l) + dot(g[2], p[2], l) + dot(g[3], p[3], l));
  for (int c = 0; c < 4; ++c)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < lanes; ++l) y[c][k][l] = along[l] * g[c][k][l];
  if (kind != Stiffness::exact) return;
  double moment[lanes];
  deviations(h, rest, moment);
  for (int l = 0; l < lanes; ++l) moment[l] *= stiffness[l];
  change_of_gradient(h, d, p, g);
  for (int c = 0; c < 4; ++c)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < lanes; ++l) y[c][k][l] += moment[l] * g[c][k][l];
}

std::vector<std::array<int, 4>> vertices_of(const Shell& shell) {
  std::vector<std::array<int, 4>> vertices;
  for (const Hinge& hinge : shell.hinges) vertices.push_back(hinge.vertices);
  return vertices;
}

double rigidity(const BendingModuli& m, double warp_share) {
  const double weft_share = 1 - warp_share;
  return m.warp * warp_share * warp_share + m.weft * weft_share * weft_share +
         (4 * m.bias - m.warp - m.weft) * warp_share * weft_share;
}

/// blocks += scale k g gᵀ of each lane, for rows of corners with a bit in `rows`.
MUSLIN_VECTOR_CODE void add_squares(const Batch<4>& g, const double* stiffness, double scale, int count,
                                    const unsigned* rows, const ElementSlabs<4>::Slots* slots,
                                    Float4* blocks) {
  float d[4][3][lanes];
  for (int l = 0; l < lanes; ++l) {
    const double root = std::sqrt(scale * stiffness[l]);
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k) d[c][k][l] = static_cast<float>(root * g[c][k][l]);
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

}  // namespace

double lowest_bias(double warp, double weft) {
  const double difference = std::sqrt(warp) - std::sqrt(weft);
  return difference * difference / 4;
}

HingeBending::HingeBending(const Shell& shell, const BendingModuli& moduli,
                           std::shared_ptr<const SymmetricPattern> block_pattern)
    : ShellEnergy(std::move(block_pattern)), slabs_(vertices_of(shell), shell.vertex_count()) {
  require(moduli.warp >= 0 && moduli.weft >= 0, "a bending modulus is negative", "give 0 or more");
  stiffness_ = slabs_.by_entry<double>([&](std::size_t e) {
    const Hinge& hinge = shell.hinges[e];
    return std::max(0.0, rigidity(moduli, hinge.warp_share)) * hinge.length * hinge.length / hinge.area;
  });
  angle_ = slabs_.by_entry<double>([&](std::size_t e) { return shell.hinges[e].angle; });
  if (pattern()) slots_ = slabs_.slots(*pattern());
}

double HingeBending::value(ConstVectors x) const {
  return slabs_.sum(0.0, [&](int first, int count) {
    Batch<4> corners;
    slabs_.gather(first, count, x, corners);
    double w[lanes], sum = 0;
    energies(stiffness_.data() + first, angle_.data() + first, corners, w);
    for (int l = 0; l < count; ++l) sum += w[l];
    return sum;
  });
}

double HingeBending::add_gradient_and_value(ConstVectors x, Vectors g) const {
  return slabs_.sum_of_batches([&](int first, int count, int owned, const ElementSlabs<4>::Slab& slab) {
    Batch<4> corners, force;
    double w[lanes], sum = 0;
    slabs_.gather(first, count, x, corners);
    gradients(stiffness_.data() + first, angle_.data() + first, corners, force, w);
    slabs_.scatter(first, count, slab, force, g);
    for (int l = 0; l < owned; ++l) sum += w[l];
    return sum;
  });
}

void HingeBending::add_gradient(ConstVectors x, Vectors g) const { add_gradient_and_value(x, g); }

void HingeBending::add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const {
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<4>::Slab& slab) {
    Batch<4> corners, along, force;
    slabs_.gather(first, count, x, corners);
    slabs_.gather(first, count, p, along);
    products(kind, stiffness_.data() + first, angle_.data() + first, corners, along, force);
    slabs_.scatter(first, count, slab, force, y);
  });
}

void HingeBending::add_stiffness_blocks(Stiffness, ConstVectors x, std::span<Mat3> blocks) const {
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<4>::Slab& slab) {
    Batch<4> corners, g;
    slabs_.gather(first, count, x, corners);
    angle_gradients(corners, g);
    for (int l = 0; l < count; ++l) {
      const auto& vertices = slabs_.vertices()[static_cast<std::size_t>(first + l)];
      for (std::size_t c = 0; c < 4; ++c) {
        if (vertices[c] < slab.vertex_begin || vertices[c] >= slab.vertex_end) continue;
        const Vec3 d(g[c][0][l], g[c][1][l], g[c][2][l]);
        blocks[static_cast<std::size_t>(vertices[c])] +=
            stiffness_[static_cast<std::size_t>(first + l)] * d * d.transpose();
      }
    }
  });
}

void HingeBending::add_stiffness_matrix(Stiffness, ConstVectors x, double scale,
                                        std::span<const double> /*masses*/, PairBlocks blocks) const {
  slabs_.for_each_batch([&](int first, int count, const ElementSlabs<4>::Slab& slab) {
    Batch<4> corners, g;
    slabs_.gather(first, count, x, corners);
    angle_gradients(corners, g);
    unsigned rows[lanes];
    slabs_.corners_in(first, count, slab, rows);
    add_squares(g, stiffness_.data() + first, scale, count, rows, slots_.data() + first, blocks.columns);
  });
}

}  // namespace muslin
