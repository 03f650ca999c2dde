// BendingFriction is the internal friction of a sheet that bends: threads and fibres that slide on each other
// resist every change of curvature, up to a moment per width M₀, and lose energy. In every triangle, along
// warp and along weft, a spring of stiffness M₀/κ₀ in series with a slider that yields at M₀ lies beside the
// elastic plate. The curvature κ_s by which the slider has moved is its memory (potential/history.hpp). A
// step minimises over the slip s ≥ 0
//
//   ψ = ½ (M₀/κ₀) (|κ − κ_s| − s)² + M₀ s,   s = max(0, |κ − κ_s| − κ₀),
//
// per area, of which the first term is stored and the second one lost. ψ is convex in κ. A sheet that curves
// in one direction, whatever it is, has the moment M₀ if both threads have. Miguel et al. (Modeling and
// estimation of internal friction in cloth, 2013) fit the friction of cloth, by Dahl's model.
// docs/theory/internal-friction.md compares both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "muslin/energy/hinge_angles.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

struct BendingFrictionLimits {
  double warp = 0;       ///< M₀ ≥ 0, moment per width, warp threads bend [N]
  double weft = 0;       ///< ≥ 0 [N]
  double curvature = 0;  ///< κ₀ > 0 [1/m]
};

class BendingFriction : public Load {
 public:
  /// `name` is unique among the loads of a run and names the array of κ_s in the history. `angles` are those
  /// of `shell`, `held` as in ShellBending. Where the history has no κ_s, the friction is unstressed at the
  /// beginning of the step. Errors: usage, if a limit is negative or κ₀ is not positive.
  BendingFriction(const std::string& name, const Shell& shell, std::shared_ptr<const HingeAngles> angles,
                  const BendingFrictionLimits& limits, std::span<const std::uint8_t> held = {});

  /// Returns an ElementEnergy. Its matrices, like those of ShellBending, are of Jᵀ Λ J, the stiffness at most
  /// 2 Λ, where Λ has only what has not slipped.
  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

 private:
  struct Sheet;
  class Energy;

  std::string name_;
  std::shared_ptr<const Sheet> sheet_;
};

}  // namespace muslin
