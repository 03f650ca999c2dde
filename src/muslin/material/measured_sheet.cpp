#include "muslin/material/measured_sheet.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

namespace muslin {
namespace {

/// A measured point as one of a StressCurve.
Vec2 tensile_point(const Vec2& measured) {
  const double stretch = 1 + measured[0];
  return {measured[0] * (1 + 0.5 * measured[0]), measured[1] / stretch};
}
Vec2 shear_point(const Vec2& measured) {
  const double angle = measured[0] * std::numbers::pi / 180;
  return {std::sin(angle), measured[1] / std::cos(angle)};
}

std::vector<Vec2> stress_points(const MeasuredCurve& curve, Vec2 (*point)(const Vec2&)) {
  std::vector<Vec2> points;
  for (const Vec2& measured : curve)
    if (measured[0] > 0) points.push_back(point(measured));
  return points;
}

StressCurve stress_curve(const std::optional<MeasuredCurve>& curve, double modulus,
                         Vec2 (*point)(const Vec2&)) {
  return curve ? StressCurve(stress_points(*curve, point)) : StressCurve(modulus);
}

}  // namespace

SheetStress stress_of(const ShellMaterial& m) {
  return {stress_curve(m.warp_curve, m.membrane_warp, tensile_point),
          stress_curve(m.weft_curve, m.membrane_weft, tensile_point),
          stress_curve(m.shear_curve, m.membrane_shear, shear_point)};
}

SheetMoments moments_of(const ShellMaterial& m) {
  const auto as_measured = [](const Vec2& point) { return point; };
  return {stress_curve(m.bending_warp_curve, m.bending_warp, as_measured),
          stress_curve(m.bending_weft_curve, m.bending_weft, as_measured)};
}

bool has_bending_curves(const ShellMaterial& m) { return m.bending_warp_curve || m.bending_weft_curve; }
bool has_bending_friction(const ShellMaterial& m) {
  return m.bending_friction_warp > 0 || m.bending_friction_weft > 0;
}
bool has_curves(const ShellMaterial& m) { return m.warp_curve || m.weft_curve || m.shear_curve; }

std::optional<std::string> problem_of_strip(const MeasuredCurve& curve) {
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (!(tensile_point(curve[i])[1] > tensile_point(curve[i - 1])[1]))
      return fmt::format("from {} to {} N/m the force rises by a smaller share than the length of the strip",
                         curve[i - 1][1], curve[i][1]);
  }
  return std::nullopt;
}

}  // namespace muslin
