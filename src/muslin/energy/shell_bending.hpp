// ShellBending is the bending energy of a shell,
//
//   W = ½ dᵀ K d,   d = w(θ − θ₀),
//
// θ the angles between the normals at its hinges, θ₀ those at rest, w the same angles within −π … π, and K
// the constant matrix of a plate with the rigidities given (energy/hinge_coupling.hpp). Where moments are
// measured over curvature, K has their least slopes and energy/moment_curves.hpp the rest. Rigid motions
// store nothing at any rest shape. The projected stiffness is the material one, Jᵀ K J with J = ∂θ/∂x. The
// blocks and matrices of a hinge's own vertices are those of Jᵀ Λ J, Λ diagonal and K ≤ 2 Λ; linear systems
// get the difference as coupled forms where the sheet is stiff relative to its masses. A triangle without
// area has no bending direction and exerts no force.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/hinge_angles.hpp"
#include "muslin/energy/hinge_coupling.hpp"
#include "muslin/energy/moment_curves.hpp"
#include "muslin/energy/shell_pattern.hpp"
#include "muslin/potential/form_coupling.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Moments per width over curvature [N over 1/m] of a sheet that curves in one direction only.
struct BendingCurves {
  BendingCurves(const StressCurve& along_warp, const StressCurve& along_weft, double at_45, double nu)
      : warp(along_warp), weft(along_weft), bias(at_45), poisson(nu) {}

  StressCurve warp, weft;
  double bias;     ///< at 45° between them, unbent [N·m]; at least the lowest_bias of the slopes at 0
  double poisson;  ///< of the part that is linear
};

class ShellBending : public ElementEnergy {
 public:
  /// `pattern` is the shell's block_pattern, or null. `held` (#V, or empty) is not 0 where a pin holds or
  /// moves a vertex. Triangles of held vertices clamp the sheet at their edges. Errors: as couple_hinges.
  ShellBending(const Shell& shell, const BendingModuli& moduli,
               std::shared_ptr<const SymmetricPattern> pattern = nullptr,
               std::span<const std::uint8_t> held = {});
  /// Gives each triangle its own moduli, #T, or one for all.
  ShellBending(const Shell& shell, std::span<const BendingModuli> moduli,
               std::shared_ptr<const SymmetricPattern> pattern, std::span<const std::uint8_t> held);
  ShellBending(const Shell& shell, const BendingCurves& curves,
               std::shared_ptr<const SymmetricPattern> pattern = nullptr,
               std::span<const std::uint8_t> held = {});

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  double add_gradient_and_value(ConstVectors x, Vectors g) const override;
  void add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const override;
  void add_stiffness_blocks(Stiffness kind, ConstVectors x, std::span<Mat3> blocks) const override;
  void add_stiffness_matrix(Stiffness kind, ConstVectors x, double scale, std::span<const double> masses,
                            PairBlocks blocks) const override;
  void linearize_stiffness(Stiffness kind, ConstVectors x, double factor, HessianSink& into,
                           std::size_t first) const override;

  /// Returns true if `scale` K is so large relative to the masses that linear systems need more than Λ.
  bool is_stiff(double scale, std::span<const double> masses, std::span<const std::uint8_t> fixed) const;

  const HingeCoupling& coupling() const { return coupling_; }
  const std::shared_ptr<const HingeAngles>& angles() const { return angles_; }

 private:
  /// Sets what linear systems need, of a plate at least as stiff as this one ever is.
  void prepare_systems(const Shell& shell, const HingeCoupling& stiffest);

  std::shared_ptr<const HingeAngles> angles_;
  HingeCoupling coupling_;  // Λ bounds all of the stiffness
  std::optional<MomentCurves> curves_;
  // With a pattern.
  std::shared_ptr<const FormCoupling> difference_;  // K − Λ
  double stiffness_ = 0;                            // of all hinges: Σ Λ |∂θ/∂x|² at rest [N/m]
};

}  // namespace muslin
