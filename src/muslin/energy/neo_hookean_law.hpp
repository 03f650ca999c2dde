// NeoHookeanLaw is a compressible Neo-Hookean solid,
//
//   ψ = μ/2 (I_C − 3) − μ/2 ln((I_C + 1)/4) + λ/2 (J − 1)² − 3/4 μ (J − 1)   [J/m³],
//
// I_C = tr FᵀF, J = det F: the stable form of Smith, de Goes, Kim, Stable Neo-Hookean Flesh Simulation
// (2018), less a constant. ψ is smooth and finite for every F, flat and inverted elements included, and the
// rest shape is its only minimum: without the logarithm, an element shrunk to a point would stay there. Hence
// no step needs a limit. With
//
//   μ = 4/3 G,   λ = L + 5/6 G,   G = E / (2 (1 + ν)),   L = 2 G ν / (1 − 2ν)
//
// small strains have Young's modulus E and Poisson's ratio ν.
#pragma once

#include <cmath>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/law.hpp"

namespace muslin {

struct NeoHookeanLaw {
  struct Constants {
    double mu, lambda;  // [Pa]
  };

  static Constants constants(double youngs_modulus, double poisson) {
    const double shear = youngs_modulus / (2 * (1 + poisson)), lame = 2 * shear * poisson / (1 - 2 * poisson);
    return {4.0 / 3 * shear, lame + 5.0 / 6 * shear};
  }

  /// ψ = polynomial + log_factor ln argument (solid_rows.hpp).
  MUSLIN_INLINE static double polynomial(const Constants& c, double ic, double j) {
    return 0.5 * c.mu * (ic - 3) + (j - 1) * (0.5 * c.lambda * (j - 1) - 0.75 * c.mu);
  }
  MUSLIN_INLINE static double log_factor(const Constants& c) { return -0.5 * c.mu; }
  MUSLIN_INLINE static double argument(double ic) { return 0.25 * (ic + 1); }

  MUSLIN_INLINE static double energy(const Constants& c, double ic, double j) {
    return polynomial(c, ic, j) + log_factor(c) * std::log(argument(ic));
  }
  template <class Real>
  MUSLIN_INLINE static Real shear(const Constants& c, Real ic) {
    return static_cast<Real>(c.mu) * ic / (ic + 1);
  }
  template <class Real>
  MUSLIN_INLINE static Real growth(const Constants& c, Real ic) {
    return static_cast<Real>(2 * c.mu) / ((ic + 1) * (ic + 1));
  }
  template <class Real>
  MUSLIN_INLINE static Real slope(const Constants& c, Real j) {
    return static_cast<Real>(c.lambda) * (j - 1) - static_cast<Real>(0.75 * c.mu);
  }
  template <class Real>
  MUSLIN_INLINE static Real curvature(const Constants& c, Real) {
    return static_cast<Real>(c.lambda);
  }
};

}  // namespace muslin
