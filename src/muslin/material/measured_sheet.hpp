// Converts the moduli or measured curves of a shell's material to stresses and moments.
#pragma once

#include <optional>
#include <string>

#include "muslin/energy/sheet_stress.hpp"
#include "muslin/material/shell_material.hpp"

namespace muslin {

/// A strip test measures the force per width F over the strain e = λ − 1: the stress is F/λ. A shear test
/// measures the force per length N over the angle φ by which the threads turn, γ = sin φ, at constant length:
/// the stress is N/cos φ. A modulus is a constant slope of the stress.
SheetStress stress_of(const ShellMaterial& material);

/// Moments per width [N] over curvature [1/m] of a sheet that curves in one direction only.
struct SheetMoments {
  StressCurve warp, weft;
};
SheetMoments moments_of(const ShellMaterial& material);

bool has_bending_curves(const ShellMaterial& material);
bool has_bending_friction(const ShellMaterial& material);
bool has_curves(const ShellMaterial& material);

/// Returns the problem of a strip's curve whose stress does not rise everywhere, as StressCurve requires;
/// empty if there is none.
std::optional<std::string> problem_of_strip(const MeasuredCurve& curve);

}  // namespace muslin
