// HingeCoupling models a plate on the triangles of a shell by a constant matrix K between the angles of its
// hinges: ½ dᵀ K d with d = θ − θ₀ is the energy of the plate
//
//   W = Σ ½ A κ:D:κ,   κ = (1/A) Σ l α n⊗n   (a triangle's sides of length l and outward normal n)
//
// of Morley (1968), where α is the angle by which the sheet's normal at the middle of a side turns from the
// triangle's own. At an edge of two triangles α₁ + α₂ = θ, and how θ divides between them is recovered from
// the five hinges of both triangles: the smallest change from halves with which every constant curvature is
// exact. So D is the rigidity on any mesh. docs/theory/shells.md derives it.
//
// D is that of an orthotropic plate, moments per width by curvatures along warp and weft and the twist:
//
//   M_uu = D_warp κ_uu + D₁₂ κ_vv,  M_vv = D₁₂ κ_uu + D_weft κ_vv,  M_uv = 2 D_twist κ_uv,
//   D₁₂ = ν √(D_warp D_weft),  D_twist = D_bias − (D_warp + D_weft + 2 D₁₂)/4,
//
// so that a sheet rolled up along warp, weft or between them has D_warp, D_weft, D_bias.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "muslin/energy/plate_curvatures.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Bending rigidities: moment per width and curvature of a sheet that curves in one direction only.
struct BendingModuli {
  double warp = 0;     ///< ≥ 0 [N·m]: warp threads bend
  double weft = 0;     ///< ≥ 0 [N·m]
  double bias = 0;     ///< at 45° between them [N·m]; at least lowest_bias
  double poisson = 0;  ///< ν, −1 … 1: M_vv / M_uu of a sheet of equal threads that curves along u only
};

/// Returns the rigidity at 45° at which the sheet no longer resists twisting.
double lowest_bias(double warp, double weft, double poisson);

/// K by rows of hinges: row e has columns[k], values[k] for first[e] ≤ k < first[e + 1], ascending. It is
/// symmetric to the last bit and positive semidefinite.
struct HingeCoupling {
  std::vector<int> first, columns;
  std::vector<double> values;  ///< [N·m]
  std::vector<double> lumped;  ///< by hinge: Λ with K ≤ 2 Λ [N·m]

  /// Returns K d.
  std::vector<double> times(std::span<const double> d) const;
};

/// Couples the hinges of `shell`. A triangle whose vertices are all in `held` (#V, or empty) is a clamp: the
/// sheet's normal at its edges is the triangle's normal. Errors: usage, if a modulus is negative, |ν| ≥ 1, or
/// the bias too low.
HingeCoupling couple_hinges(const Shell& shell, const BendingModuli& moduli,
                            std::span<const std::uint8_t> held = {});
/// Takes the moduli of each triangle, #T, or one for all. If some triangles have stiffness, those without get
/// 1e-8 of the stiffest.
HingeCoupling couple_hinges(const Shell& shell, std::span<const BendingModuli> moduli,
                            std::span<const std::uint8_t> held);
PlateCurvatures plate_curvatures(const Shell& shell, const BendingModuli& moduli,
                                 std::span<const std::uint8_t> held = {});

/// Curvatures y = R κ, κ = (κ_uu, κ_vv, 2 κ_uv), in which the plate is isotropic: D = RᵀR, so that
/// dᵀ K d = Σ A |y|².
struct EvenCurvatures {
  CurvatureRows<Vec3> rows;  ///< of y [√(N·m)/m]
  Mat3 root;                 ///< R [√(N·m)]
};
/// Errors: usage, as couple_hinges, and if no modulus is above 0.
EvenCurvatures even_curvatures(const Shell& shell, const BendingModuli& moduli,
                               std::span<const std::uint8_t> held = {});

}  // namespace muslin
