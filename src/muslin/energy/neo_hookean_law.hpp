// NeoHookeanLaw is a compressible Neo-Hookean solid,
//
//   ψ = μ/2 (I_C − 3) − μ (J − 1) + λ/2 (J − 1)²   [J/m³],   I_C = tr FᵀF,  J = det F,
//
// the stable form of Smith, de Goes, Kim, Stable Neo-Hookean Flesh Simulation (2018), without its last term,
// which only matters for elements shrunk to a point. ψ is a polynomial of F: unlike with ln J, a flat or
// inverted element has a finite energy and is pushed back, so that no step needs a limit. With
//
//   μ = E / (2 (1 + ν)),   λ = μ / (1 − 2ν)
//
// small strains have Young's modulus E and Poisson's ratio ν: λ is Lamé's plus μ, as −μ (J − 1) takes μ away
// again.
#pragma once

#include <array>
#include <limits>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"

namespace muslin {

struct NeoHookeanLaw {
  struct Constants {
    double mu, lambda;  // [Pa]
  };

  static constexpr double none = std::numeric_limits<double>::infinity();
  static constexpr std::array<LawParameter, 2> parameters = {{
      {"youngs_modulus", "Pa", 0, none, true, "Stress over strain of a bar that is pulled."},
      {"poisson", "", -1, 0.5, true, "Contraction across over stretch along."},
  }};
  static Constants constants(double youngs_modulus, double poisson) {
    const double mu = youngs_modulus / (2 * (1 + poisson));
    return {mu, mu / (1 - 2 * poisson)};
  }

  MUSLIN_INLINE static double energy(const Constants& c, double ic, double j) {
    return 0.5 * c.mu * (ic - 3) + (j - 1) * (0.5 * c.lambda * (j - 1) - c.mu);
  }
  MUSLIN_INLINE static double shear(const Constants& c) { return c.mu; }
  MUSLIN_INLINE static double slope(const Constants& c, double j) { return c.lambda * (j - 1) - c.mu; }
  MUSLIN_INLINE static double curvature(const Constants& c, double) { return c.lambda; }
};

}  // namespace muslin
