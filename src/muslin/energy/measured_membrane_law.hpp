// MeasuredMembraneLaw is an orthotropic membrane with the stresses of tests: with E = ½ (FᵀF − I) and
// γ = 2 E_uv,
//
//   ψ = f(E_uu) + g(E_vv) + c E_uu E_vv + h(γ)   [N/m],
//
// f, g and h the integrals of StressCurves, h of |γ|. Curves of constant slope make it MembraneLaw. For
// triangles. docs/theory/shells.md.
#pragma once

#include <array>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/energy/stress_curve.hpp"
#include "muslin/energy/triangle_stencil.hpp"

namespace muslin {

struct MeasuredMembraneLaw {
  struct Constants {
    StressCurve warp, weft, shear;  // f', g', h'
    double coupling;                // c [N/m]
  };
  static constexpr bool principal = false;
  static constexpr bool shared = true;

  static constexpr std::array<LawParameter, 1> parameters = {
      {{"poisson", "", 0, 1, false,
        "Contraction over stretch at rest, the geometric mean of both directions."}}};

  MUSLIN_INLINE static double energy(const Constants& c, double area, const Metric& m) {
    const double euu = 0.5 * (m.aa - 1), evv = 0.5 * (m.bb - 1);
    return area * (c.warp.energy(euu) + c.weft.energy(evv) + c.coupling * (euu * evv) +
                   c.shear.energy(magnitude(m.ab)));
  }
  MUSLIN_INLINE static PlaneStress stress(const Constants& c, double area, const Metric& m) {
    const double euu = 0.5 * (m.aa - 1), evv = 0.5 * (m.bb - 1);
    const double shear = c.shear.stress(magnitude(m.ab));
    return {area * (c.warp.stress(euu) + c.coupling * evv), area * (c.weft.stress(evv) + c.coupling * euu),
            area * (m.ab < 0 ? -shear : shear)};
  }
  MUSLIN_INLINE static PlaneModuli moduli(const Constants& c, const Metric& m) {
    return {c.warp.slope(0.5 * (m.aa - 1)), c.coupling, c.weft.slope(0.5 * (m.bb - 1)),
            c.shear.slope(magnitude(m.ab))};
  }

 private:
  MUSLIN_INLINE static double magnitude(double x) { return x < 0 ? -x : x; }
};

}  // namespace muslin
