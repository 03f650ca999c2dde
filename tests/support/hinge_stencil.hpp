// HingeStencil is an edge between two triangles, with the angle θ between their normals, as a stencil of
// Elements: hinges that are not coupled. Its measure is the deviation w = θ − θ₀ from the angle at rest,
// within −π … π. Laws give, with the weight of the element in their constants,
//
//   energy       ψ(w) [J]
//   moment       ψ'(w) [N·m]
//   curvature    ψ''(w) [N·m], with `linear` for any w
//
// and the stiffness is ψ'' ∇θ∇θᵀ + ψ' ∇²θ; projected it is the first term, without a negative ψ''.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/element_slabs.hpp"
#include "muslin/energy/hinge_geometry.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin::test {

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
    add_angle_squares(stiff.curvature, stiff.gradient, scale, count, rows, slots, blocks);
  }

 private:
  std::vector<double> rest_;  // by entry: θ₀
};

}  // namespace muslin::test
