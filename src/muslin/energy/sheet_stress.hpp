// SheetStress holds the stresses of a shell's membrane over its strains.
#pragma once

#include "muslin/energy/stress_curve.hpp"

namespace muslin {

/// Second Piola-Kirchhoff stresses [N/m] of a strip that is free to narrow over Green's strain ½ (λ² − 1)
/// along warp and weft, and of shear over the product γ of the deformed unit vectors of warp and weft.
struct SheetStress {
  StressCurve warp, weft, shear;
};

/// Returns the largest Poisson's ratio with which a sheet of these stresses is stable at all strains while no
/// thread buckles: 1 unless a curve softens.
double highest_poisson(const SheetStress& stress);

}  // namespace muslin
