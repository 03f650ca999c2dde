// MomentCurves is the energy of a bent plate beyond that of its constant matrix K (energy/shell_bending.hpp):
// of every triangle of area A
//
//   A (f(|κ_uu|) + g(|κ_vv|)),   κ = B d,
//
// f and g the integrals of StressCurves [N] over the curvatures that triangle has along warp and weft by the
// deviations d of its hinges, the same for which K is exact.
#pragma once

#include <span>
#include <vector>

#include "muslin/energy/plate_curvatures.hpp"
#include "muslin/energy/stress_curve.hpp"

namespace muslin {

class MomentCurves {
 public:
  /// `areas` are those of the triangles [m²].
  MomentCurves(PlateCurvatures curvatures, std::vector<double> areas, const StressCurve& warp,
               const StressCurve& weft);

  double energy(std::span<const double> bent) const;
  /// moments += the gradient of the energy by `bent`, #H. Returns the energy.
  double add_moments(std::span<const double> bent, std::span<double> moments) const;
  /// moments += the Hessian at `bent` times `change`.
  void add_changes(std::span<const double> bent, std::span<const double> change,
                   std::span<double> moments) const;

 private:
  PlateCurvatures curvatures_;
  std::vector<double> areas_;
  StressCurve warp_, weft_;
};

}  // namespace muslin
