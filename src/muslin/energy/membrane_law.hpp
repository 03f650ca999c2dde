// MembraneLaw is an orthotropic St. Venant-Kirchhoff membrane: with E = ½ (FᵀF − I),
//
//   ψ = ½ (C₁₁ E_uu² + 2 C₁₂ E_uu E_vv + C₂₂ E_vv² + G (2 E_uv)²)   [N/m],
//
// whose threads buckle (cell_buckling.hpp). For triangles.
#pragma once

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/cell_buckling.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/energy/triangle_stencil.hpp"

namespace muslin {

struct MembraneLaw {
  struct Constants {
    double c11, c12, c22, g;      // [N/m]
    double load_warp, load_weft;  // [N·m]
  };
  static constexpr bool principal = false;

  MUSLIN_INLINE static double energy(const Constants& c, double area, const Metric& m) {
    return 0.5 * area * (threads(c, area, m).twice_energy + c.g * (m.ab * m.ab));
  }
  MUSLIN_INLINE static PlaneStress stress(const Constants& c, double area, const Metric& m) {
    const ThreadState t = threads(c, area, m);
    return {area * t.uu, area * t.vv, area * (c.g * m.ab)};
  }
  MUSLIN_INLINE static PlaneModuli moduli(const Constants& c, double area, const Metric& m) {
    const ThreadState t = threads(c, area, m);
    return {t.c11, t.c12, t.c22, c.g};
  }

 private:
  MUSLIN_INLINE static ThreadState threads(const Constants& c, double area, const Metric& m) {
    return state_of({c.c11, c.c12, c.c22, c.load_warp, c.load_weft}, area, 0.5 * (m.aa - 1),
                    0.5 * (m.bb - 1));
  }
};

}  // namespace muslin
