// PlasticMembraneLaw is an orthotropic St. Venant-Kirchhoff membrane whose threads stay longer where they are
// pulled too far. With E = ½ (FᵀF − I), ε = (E_uu, E_vv), the plastic strains ε_p of both threads, e = ε −
// ε_p, C the moduli of stretch, r the stresses at which threads yield, and the share h of the stiffness that
// is left beyond yield, a step minimises over the slips s ≥ 0
//
//   ψ = ½ h ε·C ε + (1 − h) (½ (e − s)·C (e − s) + r·s) + ½ G (2 E_uv)²   [N/m]:
//
// r·s is lost, the others are stored. Either no thread slips, one, or both. For triangles.
// docs/theory/plasticity.md.
#pragma once

#include <array>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/energy/triangle_stencil.hpp"

namespace muslin {

struct PlasticMembraneLaw {
  struct Constants {
    double c11, c12, c22, g;            // C positive definite [N/m]
    double yield_warp, yield_weft;      // r [N/m]
    double hardening;                   // h
    double plastic_warp, plastic_weft;  // ε_p at the beginning of the step
  };
  static constexpr bool principal = false;

  /// The slips of both threads.
  struct Slip {
    double warp, weft;
  };
  MUSLIN_INLINE static Slip slip(const Constants& c, const Metric& m) {
    const State s = state(c, m);
    return {s.slip1, s.slip2};
  }
  MUSLIN_INLINE static double dissipated(const Constants& c, double area, const Metric& m) {
    const State s = state(c, m);
    return area * (1 - c.hardening) * (c.yield_warp * s.slip1 + c.yield_weft * s.slip2);
  }

  MUSLIN_INLINE static double energy(const Constants& c, double area, const Metric& m) {
    const State s = state(c, m);
    const double h = c.hardening;
    const double whole = form(c, s.strain1, s.strain2), elastic = form(c, s.elastic1, s.elastic2);
    return 0.5 * area * (h * whole + (1 - h) * elastic + c.g * (m.ab * m.ab)) + dissipated(c, area, m);
  }
  MUSLIN_INLINE static PlaneStress stress(const Constants& c, double area, const Metric& m) {
    const State s = state(c, m);
    const double h = c.hardening;
    const double e1 = h * s.strain1 + (1 - h) * s.elastic1, e2 = h * s.strain2 + (1 - h) * s.elastic2;
    return {area * (c.c11 * e1 + c.c12 * e2), area * (c.c12 * e1 + c.c22 * e2), area * (c.g * m.ab)};
  }
  MUSLIN_INLINE static PlaneModuli moduli(const Constants& c, double, const Metric& m) {
    const State s = state(c, m);
    const double h = c.hardening;
    const bool first = s.slip1 > 0, second = s.slip2 > 0;
    const double c11 = first ? 0 : second ? c.c11 - c.c12 * c.c12 / c.c22 : c.c11;
    const double c22 = second ? 0 : first ? c.c22 - c.c12 * c.c12 / c.c11 : c.c22;
    const double c12 = first || second ? 0 : c.c12;
    return {h * c.c11 + (1 - h) * c11, h * c.c12 + (1 - h) * c12, h * c.c22 + (1 - h) * c22, c.g};
  }

 private:
  struct State {
    double strain1, strain2, elastic1, elastic2, slip1, slip2;
  };
  MUSLIN_INLINE static double form(const Constants& c, double e1, double e2) {
    return c.c11 * e1 * e1 + 2 * c.c12 * e1 * e2 + c.c22 * e2 * e2;
  }
  MUSLIN_INLINE static State state(const Constants& c, const Metric& m) {
    const double strain1 = 0.5 * (m.aa - 1), strain2 = 0.5 * (m.bb - 1);
    const double e1 = strain1 - c.plastic_warp, e2 = strain2 - c.plastic_weft;
    // By how much the stress without slip exceeds the yield stress.
    const double g1 = c.c11 * e1 + c.c12 * e2 - c.yield_warp, g2 = c.c12 * e1 + c.c22 * e2 - c.yield_weft;
    const double determinant = c.c11 * c.c22 - c.c12 * c.c12;
    const double both1 = (c.c22 * g1 - c.c12 * g2) / determinant;
    const double both2 = (c.c11 * g2 - c.c12 * g1) / determinant;
    const bool both = both1 > 0 && both2 > 0;
    const bool first = !both && g1 > 0 && c.c11 * g2 <= c.c12 * g1;
    const bool second = !both && !first && g2 > 0;
    const double slip1 = both ? both1 : first ? g1 / c.c11 : 0;
    const double slip2 = both ? both2 : second ? g2 / c.c22 : 0;
    return {strain1, strain2, e1 - slip1, e2 - slip2, slip1, slip2};
  }
};

}  // namespace muslin
