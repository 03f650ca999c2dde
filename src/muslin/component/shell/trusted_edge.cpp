#include "muslin/component/shell/trusted_edge.hpp"

#include <cmath>
#include <limits>

#include "muslin/material/measured_sheet.hpp"

namespace muslin {
namespace {

constexpr double gravity = 9.81;  // [m/s²]
/// Edges of a fold of radius L, and the energy of the membrane over that of bending, at which drape
/// coefficients are off by 5 points.
constexpr double edges_of_fold = 2.5, energy_ratio = 16;

double mean(double along_warp, double along_weft) { return std::sqrt(along_warp * along_weft); }

double bending_stiffness(const ShellMaterial& material) {
  const SheetMoments moments = moments_of(material);
  return mean(moments.warp.slope(0), moments.weft.slope(0));
}

/// L: the radius of folds under their own weight [m].
double fold_radius(const ShellMaterial& material) {
  return std::cbrt(bending_stiffness(material) / (gravity * material.areal_density));
}

}  // namespace

TrustedEdge trusted_edge(const ShellMaterial& material, Compression compression) {
  const double radius = fold_radius(material);
  TrustedEdge edge{radius / edges_of_fold, std::numeric_limits<double>::infinity()};
  const SheetStress stress = stress_of(material);
  const double stiffness = mean(stress.warp.slope(0), stress.weft.slope(0));
  if (compression == Compression::buckling || !(stiffness > 0)) return edge;
  edge.unlocked =
      std::pow(energy_ratio * 576 * bending_stiffness(material) * radius * radius / stiffness, 0.25);
  return edge;
}

}  // namespace muslin
