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

#include <memory>
#include <vector>

#include "muslin/energy/elements.hpp"
#include "muslin/energy/hinge_law.hpp"
#include "muslin/energy/hinge_stencil.hpp"
#include "muslin/energy/shell_pattern.hpp"
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

/// Returns k of every hinge [N·m]. Errors: usage, if a modulus is negative.
std::vector<double> hinge_stiffnesses(const Shell& shell, const BendingModuli& moduli);

extern template class Elements<HingeStencil, HingeLaw>;

class HingeBending : public Elements<HingeStencil, HingeLaw> {
 public:
  /// `pattern` is the shell's block_pattern, or null.
  HingeBending(const Shell& shell, const BendingModuli& moduli,
               std::shared_ptr<const SymmetricPattern> pattern = nullptr);

 private:
  HingeBending(std::shared_ptr<const Slabs> slabs, const Shell& shell, const std::vector<double>& stiffness,
               std::shared_ptr<const SymmetricPattern> pattern);
};

}  // namespace muslin
