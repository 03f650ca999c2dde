// MembraneLaw is an orthotropic St. Venant-Kirchhoff membrane: with E = ½ (FᵀF − I),
//
//   ψ = ½ (C₁₁ E_uu² + 2 C₁₂ E_uu E_vv + C₂₂ E_vv² + G (2 E_uv)²)   [N/m]
//
// For triangles.
#pragma once

#include <array>
#include <limits>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"
#include "muslin/energy/triangle_stencil.hpp"

namespace muslin {

struct MembraneLaw {
  using Constants = PlaneModuli;  // [N/m]
  static constexpr bool principal = false;

  static constexpr double none = std::numeric_limits<double>::infinity();
  static constexpr std::array<LawParameter, 4> parameters = {{
      {"membrane_warp", "N/m", 0, none, false,
       "Force per width and strain along warp: Young's modulus × thickness."},
      {"membrane_weft", "N/m", 0, none, false, "Force per width and strain along weft."},
      {"membrane_shear", "N/m", 0, none, false, "Force per width and radian of shear."},
      {"poisson", "", -1, 1, true, "Contraction over stretch, the geometric mean of both directions."},
  }};

  MUSLIN_INLINE static double energy(const Constants& c, double area, const Metric& m) {
    const double euu = 0.5 * (m.aa - 1), evv = 0.5 * (m.bb - 1);
    return 0.5 * area *
           (c.c11 * (euu * euu) + 2 * c.c12 * (euu * evv) + c.c22 * (evv * evv) + c.g * (m.ab * m.ab));
  }
  MUSLIN_INLINE static PlaneStress stress(const Constants& c, double area, const Metric& m) {
    const double euu = 0.5 * (m.aa - 1), evv = 0.5 * (m.bb - 1);
    return {area * (c.c11 * euu + c.c12 * evv), area * (c.c12 * euu + c.c22 * evv), area * (c.g * m.ab)};
  }
  MUSLIN_INLINE static PlaneModuli moduli(const Constants& c) { return c; }
};

}  // namespace muslin
