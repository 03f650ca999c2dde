// The clamps of a strip test keep the strip from narrowing beside them. A long strip has the stress of one that
// is free to narrow, S = f(E); one much wider than long that of one held everywhere, S = f(E) +
// ν²/(1 − ν²) f'(0) E (docs/theory/shells.md). Other strips have a share of the second term.
#pragma once

#include "muslin/fit/inversion.hpp"
#include "muslin/fit/measurements.hpp"

namespace muslin {

/// Sets the share `held` of strips whose width and length are known, and of those of KES, 0.2 m by 0.05 m:
/// that of a simulated strip with the moduli at rest of the inversion.
void hold_strips(Measurements& measurements, const Inversion& inversion);

/// Moduli at rest of a sheet along the pull, across it, in shear [N/m], and Poisson's ratio.
struct StripModuli {
  double along = 0, across = 0, shear = 0, poisson = 0;
};

/// Returns the share for a strip of this width and length [m]. Errors: solver.
double held_share(double width, double length, const StripModuli& moduli);

}  // namespace muslin
