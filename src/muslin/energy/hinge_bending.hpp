// HingeBending is the bending energy of a shell, with a hinge at every inner edge.
//
//   W = Σ ½ k w(θ − θ₀)²,   k = D l² / (A₁ + A₂)   [N·m]
//
// l the edge and A₁, A₂ the triangles at rest, θ the angle between the normals, θ₀ that at rest, w the same
// angle within −π … π. On a regular mesh this is the bending energy ½ D κ² per area of a sheet that curves
// across the edge (Grinspun, Hirani, Desbrun, Schröder 2003, with the constant that makes D the rigidity).
// D depends on the direction of bending, at the angle φ from warp, as for an orthotropic plate:
//
//   D = D_warp cos⁴φ + D_weft sin⁴φ + (4 D_bias − D_warp − D_weft) cos²φ sin²φ,
//
// which is D_bias at 45°. For the gradient of θ see docs/theory/shells.md. The projected stiffness is k
// ∇θ∇θᵀ. A triangle without area has no bending direction and exerts no force.
#pragma once

#include <vector>

#include "muslin/energy/element_slabs.hpp"
#include "muslin/energy/shell_energy.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Bending rigidities: moment per width and curvature.
struct BendingModuli {
  double warp = 0;  ///< ≥ 0 [N·m]: warp threads bend
  double weft = 0;  ///< ≥ 0 [N·m]
  double bias = 0;  ///< at 45° between them [N·m]; at least lowest_bias
};

/// Returns the least rigidity at 45° for which no direction between has a negative one: (√warp − √weft)²/4.
double lowest_bias(double warp, double weft);

class HingeBending : public ShellEnergy {
 public:
  /// `pattern` is the shell's block_pattern, or null.
  HingeBending(const Shell& shell, const BendingModuli& moduli,
               std::shared_ptr<const SymmetricPattern> pattern = nullptr);

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  double add_gradient_and_value(ConstVectors x, Vectors g) const override;
  void add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const override;
  void add_stiffness_blocks(Stiffness kind, ConstVectors x, std::span<Mat3> blocks) const override;
  void add_stiffness_matrix(Stiffness kind, ConstVectors x, double scale, std::span<const double> masses,
                            PairBlocks blocks) const override;

 private:
  ElementSlabs<4> slabs_;
  std::vector<ElementSlabs<4>::Slots> slots_;  // by entry: the block of each pair of corners
  std::vector<double> stiffness_, angle_;      // by entry: k [N·m] and θ₀
};

}  // namespace muslin
