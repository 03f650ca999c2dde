// MembraneEnergy resists stretch and shear of a shell: an orthotropic St. Venant-Kirchhoff membrane on linear
// triangles.
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
// positive semidefinite part of S there, the bounded one that and as much of the rest as the triangle's share
// of the masses holds. docs/theory/shells.md.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "muslin/energy/element_slabs.hpp"
#include "muslin/energy/shell_energy.hpp"
#include "muslin/energy/triangle_stencil.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Stiffnesses of a sheet: force per width and strain.
struct MembraneModuli {
  double warp = 0;     ///< K_u ≥ 0 [N/m]: Young's modulus × thickness along warp
  double weft = 0;     ///< K_v ≥ 0 [N/m]
  double shear = 0;    ///< G ≥ 0 [N/m]: force per width and radian
  double poisson = 0;  ///< ν, the geometric mean of the two, −1 < ν < 1
};

class MembraneEnergy : public ShellEnergy {
 public:
  /// `pattern` is the shell's block_pattern, or null.
  MembraneEnergy(const Shell& shell, const MembraneModuli& moduli,
                 std::shared_ptr<const SymmetricPattern> pattern = nullptr);

  double value(ConstVectors x) const override;
  void add_gradient(ConstVectors x, Vectors g) const override;
  double add_gradient_and_value(ConstVectors x, Vectors g) const override;
  void add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p, Vectors y) const override;
  void add_stiffness_blocks(Stiffness kind, ConstVectors x, std::span<Mat3> blocks) const override;
  void add_stiffness_matrix(Stiffness kind, ConstVectors x, double scale, std::span<const double> masses,
                            PairBlocks blocks) const override;

  struct Constants {
    double c11 = 0, c12 = 0, c22 = 0, g = 0;  ///< [N/m]
  };

 private:
  Constants constants_;
  ElementSlabs<3> slabs_;
  std::vector<ElementSlabs<3>::Slots> slots_;  // by entry: the block of each pair of corners
  TriangleRests rests_;
  std::vector<std::array<double, 3>> mass_shares_;  // by entry: of the corners' masses
  std::vector<double> stiffness_;                   // by entry: trace of the material blocks at rest [N/m]
};

}  // namespace muslin
