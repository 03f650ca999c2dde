// MeasuredMembraneLaw is an orthotropic membrane with the stresses of tests: with E = ½ (FᵀF − I) and
// γ = 2 E_uv,
//
//   ψ = ψ₀(E_uu, E_vv) + f(E_uu) + g(E_vv) + h(γ)   [N/m],
//
// ψ₀ that of threads with the slopes at rest, which may buckle (cell_buckling.hpp), f, g and h the integrals
// of StressCurves, h of |γ|, f and g of what the curves of threads deviate from these slopes. Curves of
// constant slope make it MembraneLaw. For triangles. docs/theory/shells.md.
#pragma once

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/cell_buckling.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/energy/stress_curve.hpp"
#include "muslin/energy/triangle_stencil.hpp"

namespace muslin {

struct MeasuredMembraneLaw {
  struct Constants {
    Threads threads;                // of ψ₀
    StressCurve warp, weft, shear;  // f', g', h'
  };
  static constexpr bool principal = false;
  static constexpr bool shared = true;

  MUSLIN_INLINE static double energy(const Constants& c, double area, const Metric& m) {
    const double euu = 0.5 * (m.aa - 1), evv = 0.5 * (m.bb - 1);
    return area * (0.5 * state_of(c.threads, area, euu, evv).twice_energy + c.warp.energy(euu) +
                   c.weft.energy(evv) + c.shear.energy(magnitude(m.ab)));
  }
  MUSLIN_INLINE static PlaneStress stress(const Constants& c, double area, const Metric& m) {
    const double euu = 0.5 * (m.aa - 1), evv = 0.5 * (m.bb - 1);
    const ThreadState t = state_of(c.threads, area, euu, evv);
    const double shear = c.shear.stress(magnitude(m.ab));
    return {area * (t.uu + c.warp.stress(euu)), area * (t.vv + c.weft.stress(evv)),
            area * (m.ab < 0 ? -shear : shear)};
  }
  MUSLIN_INLINE static PlaneModuli moduli(const Constants& c, double area, const Metric& m) {
    const double euu = 0.5 * (m.aa - 1), evv = 0.5 * (m.bb - 1);
    const ThreadState t = state_of(c.threads, area, euu, evv);
    return {t.c11 + c.warp.slope(euu), t.c12, t.c22 + c.weft.slope(evv), c.shear.slope(magnitude(m.ab))};
  }

 private:
  MUSLIN_INLINE static double magnitude(double x) { return x < 0 ? -x : x; }
};

}  // namespace muslin
