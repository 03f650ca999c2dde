// MeasuredMembrane resists stretch and shear of a shell by measured curves (measured_membrane_law.hpp). With
// T_u and T_v the stresses that a strip pulled along warp or weft has over its strain, free to narrow, K_u
// and K_v their slopes at rest and ν Poisson's ratio,
//
//   C₁₁ = K_u/(1−ν²),   C₂₂ = K_v/(1−ν²),   C₁₂ = ν √(K_u K_v)/(1−ν²),
//   f' = T_u − K_u E_uu,   g' = T_v − K_v E_vv,
//
// so that such a strip has exactly T_u or T_v, and narrows in proportion to its strain. Unless threads
// buckle, ψ is convex for ν up to highest_poisson (energy/sheet_stress.hpp). docs/theory/shells.md.
#pragma once

#include <memory>

#include "muslin/energy/elements.hpp"
#include "muslin/energy/measured_membrane_law.hpp"
#include "muslin/energy/sheet_stress.hpp"
#include "muslin/energy/shell_pattern.hpp"
#include "muslin/energy/triangle_stencil.hpp"
#include "muslin/shell/shell.hpp"

namespace muslin {

extern template class Elements<TriangleStencil, MeasuredMembraneLaw>;

class MeasuredMembrane : public Elements<TriangleStencil, MeasuredMembraneLaw> {
 public:
  /// `pattern` is the shell's block_pattern, or null. Errors: usage, unless 0 ≤ poisson ≤ highest_poisson and
  /// < 1.
  MeasuredMembrane(const Shell& shell, const SheetStress& stress, double poisson,
                   std::shared_ptr<const SymmetricPattern> pattern = nullptr,
                   const BucklingRigidity& rigidity = {});

 private:
  MeasuredMembrane(std::shared_ptr<const Slabs> slabs, const Shell& shell,
                   const MeasuredMembraneLaw::Constants& constants,
                   std::shared_ptr<const SymmetricPattern> pattern);
};

}  // namespace muslin
