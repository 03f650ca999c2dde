// MembraneEnergy resists stretch and shear of a shell: an orthotropic St. Venant-Kirchhoff membrane on linear
// triangles, whose threads may buckle (cell_buckling.hpp). Unless they do,
//
//   W = Σ ½ A (C₁₁ E_uu² + 2 C₁₂ E_uu E_vv + C₂₂ E_vv² + G (2 E_uv)²),   E = ½ (FᵀF − I),
//
// F = [a, b] the 3 by 2 deformation gradient: a and b are the deformed unit vectors of warp and weft. With
// the plane-stress constants C₁₁ = K_u/(1−ν²), C₂₂ = K_v/(1−ν²), C₁₂ = ν √(K_u K_v)/(1−ν²) a strip pulled
// along warp or weft, free to narrow, has the stiffness K_u or K_v. With S = (S_uu, S_vv, S_uv) the second
// Piola-Kirchhoff stress [N/m],
//
//   dW = Σ A (S_uu a·da + S_vv b·db + S_uv (a·db + b·da)).
//
// The exact Hessian adds the geometric stiffness S ⊗ I to the material one; the projected one takes the
// positive semidefinite part of S there, the bounded one adds as much of the negative part as the triangle's
// share of the masses can balance (docs/theory/shells.md).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "muslin/energy/cell_buckling.hpp"
#include "muslin/energy/elements.hpp"
#include "muslin/energy/membrane_law.hpp"
#include "muslin/energy/shell_pattern.hpp"
#include "muslin/energy/triangle_stencil.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Stiffnesses of a sheet: force per width and strain.
struct MembraneModuli {
  double warp = 0;     ///< K_u ≥ 0 [N/m]: Young's modulus × thickness along warp
  double weft = 0;     ///< K_v ≥ 0 [N/m]
  double shear = 0;    ///< G ≥ 0 [N/m]: force per width and radian
  double poisson = 0;  ///< ν, geometric mean of both directions, −1 < ν < 1
};

/// Returns the moduli of stretch and shear in plane stress. Errors: usage, if one is out of its range.
PlaneModuli plane_moduli(const MembraneModuli& moduli);

extern template class Elements<TriangleStencil, MembraneLaw>;

class MembraneEnergy : public Elements<TriangleStencil, MembraneLaw> {
 public:
  /// `pattern` is the shell's block_pattern, or null. Errors: usage, if a modulus is out of its range.
  MembraneEnergy(const Shell& shell, const MembraneModuli& moduli,
                 std::shared_ptr<const SymmetricPattern> pattern = nullptr,
                 const BucklingRigidity& rigidity = {});
  /// Gives each triangle its own moduli, #T, and rigidity, #T or empty: elastic compression.
  MembraneEnergy(const Shell& shell, std::span<const MembraneModuli> moduli,
                 std::shared_ptr<const SymmetricPattern> pattern = nullptr,
                 std::span<const BucklingRigidity> rigidities = {});

 private:
  MembraneEnergy(std::shared_ptr<const Slabs> slabs, const Shell& shell,
                 const std::vector<PlaneModuli>& moduli, std::span<const BucklingRigidity> rigidities,
                 std::shared_ptr<const SymmetricPattern> pattern);
};

}  // namespace muslin
