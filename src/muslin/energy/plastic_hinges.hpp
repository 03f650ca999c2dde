// PlasticHinges models the bending of a shell that keeps a fold, such as paper or foil. Each hinge stores its
// plastic angle and its slip (potential/history.hpp). Unlike the hinges of ShellBending these are not
// coupled:
//
//   W = Σ ψ(w(θ − θ₀)),   ψ'' = D l² / (A₁ + A₂) below the yield angle   [N·m]
//
// with l the length of the edge and A₁, A₂ the areas of the triangles at rest, and D the rigidity for bending
// across the edge, at the angle φ from warp,
//
//   D = D_warp cos⁴φ + D_weft sin⁴φ + (4 D_bias − D_warp − D_weft) cos²φ sin²φ.
//
// This is the rigidity of squares cut in two that bend along their sides (Grinspun, Hirani, Desbrun, Schröder
// 2003); on other meshes and in other directions it is 0.7 to 3 times as much. ν is not used.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "muslin/energy/elements.hpp"
#include "muslin/energy/hinge_coupling.hpp"
#include "muslin/energy/hinge_stencil.hpp"
#include "muslin/energy/plastic_hinge_law.hpp"
#include "muslin/energy/shell_pattern.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

struct YieldLimit {
  double angle = 0;      ///< θ_y ≥ 0 of a hinge
  double hardening = 0;  ///< h ≥ 0
};

extern template class Elements<HingeStencil, PlasticHingeLaw>;

class PlasticHinges : public Load {
 public:
  /// `name` is unique among the loads of a run and names the hinges' arrays in the history. `pattern` is the
  /// shell's block_pattern, or null. Errors: usage, if a modulus or the limit is negative.
  PlasticHinges(const std::string& name, const Shell& shell, const BendingModuli& moduli,
                const YieldLimit& limit, std::shared_ptr<const SymmetricPattern> pattern = nullptr);
  ~PlasticHinges() override;

  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

  /// Returns θ_p of every hinge, in a history of a run; empty before the first step.
  std::span<const double> plastic_angles(const History& history) const;

 private:
  class Energy;

  std::string plastic_name_, slip_name_;
  std::size_t count_;
  std::shared_ptr<const Energy> at_rest_;
};

}  // namespace muslin
