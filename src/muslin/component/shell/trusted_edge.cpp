#include "muslin/component/shell/trusted_edge.hpp"

#include <cmath>

#include "muslin/material/measured_sheet.hpp"

namespace muslin {
namespace {

constexpr double gravity = 9.81;  // [m/s²]
/// Edges of a fold of radius L, and the energy of the membrane over that of bending, at which drape
/// coefficients are off by 3 points.
constexpr double edges_of_fold = 2, energy_ratio = 16;

double mean(double along_warp, double along_weft) { return std::sqrt(along_warp * along_weft); }

double bending_stiffness(const ShellMaterial& material) {
  const SheetMoments moments = moments_of(material);
  return mean(moments.warp.slope(0), moments.weft.slope(0));
}

/// L: the radius of folds under their own weight [m].
double fold_radius(const ShellMaterial& material) {
  return std::cbrt(bending_stiffness(material) / (gravity * material.areal_density));
}

/// h⁴ K of edges that are just unlocked [N·m³].
double unlocked_product(const ShellMaterial& material) {
  return energy_ratio * 576 * bending_stiffness(material) * std::pow(fold_radius(material), 2);
}

}  // namespace

TrustedEdge trusted_edge(const ShellMaterial& material) {
  const SheetStress stress = stress_of(material);
  const double stiffness = mean(stress.warp.slope(0), stress.weft.slope(0));
  return {fold_radius(material) / edges_of_fold, std::pow(unlocked_product(material) / stiffness, 0.25)};
}

double unlocked_stiffness(const ShellMaterial& material, double h) {
  return unlocked_product(material) / std::pow(h, 4);
}

}  // namespace muslin
