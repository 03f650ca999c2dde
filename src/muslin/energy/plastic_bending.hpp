// PlasticBending is the bending of a sheet that takes a set, such as paper or foil: a plate of rigidity D
// (energy/shell_bending.hpp) that yields in every triangle where its elastic curvature is too large, and then
// hardens linearly and kinematically. With the curvatures y = R κ in which the plate is isotropic
// (EvenCurvatures), the plastic ones y_p and the share h of the rigidity that is left beyond yield, a step
// minimises over the slip s ≥ 0, in the direction of e = y − y_p,
//
//   ψ = ½ h |y|² + (1 − h) (½ (|e| − s)² + r s),   s = max(0, |e| − r),
//
// per area: its last term is lost, the others are stored. r is |y| of a sheet whose warp bends by the yield
// curvature. ψ is convex in κ. κ_p = R⁻¹ y_p is the memory (potential/history.hpp). This is a variational
// update (Ortiz, Stainier, The variational formulation of viscoplastic constitutive updates, 1999) of a
// radial return (Wilkins, Calculation of elastic-plastic flow, 1964). docs/theory/plasticity.md derives it.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "muslin/energy/shell_bending.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

struct BendingYield {
  double curvature = 0;  ///< > 0: elastic curvature beyond which a sheet whose warp bends takes a set [1/m]
  double hardening = 0;  ///< h, 0 … 1: rigidity beyond yield over that below
  double recovery = std::numeric_limits<double>::infinity();  ///< > 0: time in which sets fade to 1/e [s]
};

class PlasticBending : public Load {
 public:
  /// `name` is unique among the loads of a run and names the array of κ_p in the history: three numbers per
  /// triangle, κ_uu, κ_vv and 2 κ_uv. `elastic` is the plate of `shell`, `moduli` and `held` without yield.
  /// Errors: usage, if no modulus is above 0 or a number of `yield` is out of range.
  PlasticBending(const std::string& name, const Shell& shell, const BendingModuli& moduli,
                 const BendingYield& yield, std::shared_ptr<const ShellBending> elastic,
                 std::span<const std::uint8_t> held = {});

  /// Returns an ElementEnergy, whose matrices are like those of ShellBending, of the stiffness that is left.
  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

 private:
  struct Sheet;
  class Energy;

  std::string name_;
  std::shared_ptr<const Sheet> sheet_;
};

}  // namespace muslin
