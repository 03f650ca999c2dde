// StretchLimitEnergy limits the stretch of a shell, in every direction of every triangle:
//
//   W = Σ A κ (ψ(λ₁) + ψ(λ₂)),
//
// λ₁ ≥ λ₂ the singular values of F = [a, b], the 3 by 2 deformation gradient (membrane_energy.hpp): the
// largest and the smallest stretch within the triangle. With s₁ the limit, s₀ = (1 + s₁)/2 the onset,
// d = s₁ − s₀ and u = (λ − s₀)/d,
//
//   u ≤ 0        ψ = 0
//   u ≤ 1/2      ψ = −d² u² ln(1 − u)                    the barrier of Li et al. 2020, eq. 6
//   else         the parabola with the same value, slope and curvature at 1/2,
//
// twice continuously differentiable, convex, increasing, finite everywhere: a triangle of three times its
// length is pulled back. ψ'' is at most 6.39, ψ' is 4.39 d at the limit. The limit is thus stiff, but not
// hard; docs/theory/shells.md discusses the cost of a hard one.
//
// With F = Σ λᵢ uᵢ vᵢᵀ the Hessian has the eigenvalues (the 3 by 2 case of the analysis in Kim, Eberle,
// Dynamic Deformables, 2022)
//
//   A κ ψ''(λᵢ)                       uᵢvᵢᵀ               stretch
//   A κ (ψ'(λ₁) + ψ'(λ₂))/(λ₁ + λ₂)   u₁v₂ᵀ − u₂v₁ᵀ       turning in the plane
//   A κ (ψ'(λ₁) − ψ'(λ₂))/(λ₁ − λ₂)   u₁v₂ᵀ + u₂v₁ᵀ       shear; ψ'' where both are equal
//   A κ ψ'(λᵢ)/λᵢ                     n vᵢᵀ               out of the plane
//
// all ≥ 0, as ψ' is neither negative nor decreasing: the exact stiffness is the projected one.
// docs/theory/shells.md.
#pragma once

#include <memory>
#include <span>

#include "muslin/energy/elements.hpp"
#include "muslin/energy/stretch_limit_law.hpp"
#include "muslin/energy/triangle_stencil.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

/// Returns κ [N/m] for a shell of this membrane stiffness [N/m], mass [kg] and mean edge h [m]: twice the
/// larger of the first and m g/(h (s₁ − 1)). If one vertex carries all the weight, the tension is m g/h; the
/// limit is reached at 4.4 times that for any fabric. g is 9.81 m/s² in every scene.
double stretch_limit_stiffness(double membrane, double mass, double mean_edge, double limit);

extern template class Elements<TriangleStencil, StretchLimitLaw>;

class StretchLimitEnergy : public Elements<TriangleStencil, StretchLimitLaw> {
 public:
  /// limit > 1, stiffness κ ≥ 0 [N/m]; `pattern` is the shell's block_pattern, or null. The material kind of
  /// stiffness is that of stretch alone.
  StretchLimitEnergy(const Shell& shell, double limit, double stiffness,
                     std::shared_ptr<const SymmetricPattern> pattern = nullptr);

  /// Gives each triangle its own limit and stiffness, #T.
  StretchLimitEnergy(const Shell& shell, std::span<const double> limits, std::span<const double> stiffnesses,
                     std::shared_ptr<const SymmetricPattern> pattern);
  /// Has the triangles of another one.
  StretchLimitEnergy(const StretchLimitEnergy& other, std::span<const double> limits,
                     std::span<const double> stiffnesses);

 private:
  StretchLimitEnergy(std::shared_ptr<const Slabs> slabs, const Shell& shell, std::span<const double> limits,
                     std::span<const double> stiffnesses, std::shared_ptr<const SymmetricPattern> pattern);
};

}  // namespace muslin
