// TrustedEdge is the edge length up to which a mesh drapes as the fabric does.
//
// Cloth that hangs has folds of curvature κ ≈ 1/L, where bending balances weight: L = (D/ρg)^⅓. Edges that
// cut across a fold are its chords, shorter by (κh)²/24 than the fold. A fold that does not follow edges
// strains the membrane by that much. If it resists compression as it does tension, its stiffness K adds to
// that of bending (docs/theory/shells.md, "Edge length").
#pragma once

#include "muslin/component/shell/shell_body_settings.hpp"
#include "muslin/material/shell_material.hpp"

namespace muslin {

struct TrustedEdge {
  double resolved = 0;  ///< longer edges do not resolve the folds [m]
  double unlocked = 0;  ///< on longer edges an elastic membrane hinders folds [m]; infinite where none does

  double length() const { return unlocked < resolved ? unlocked : resolved; }
};

/// Returns the lengths for a fabric under its own weight on Earth, with its stiffness at rest. 0 without
/// bending stiffness, as folds of such a fabric are as small as the mesh allows.
TrustedEdge trusted_edge(const ShellMaterial& material, Compression compression);

}  // namespace muslin
