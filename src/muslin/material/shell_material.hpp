// ShellMaterial holds the material data of a shell, per area and per width, as fabrics are measured.
#pragma once

#include <optional>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin {

namespace schema {
struct Table;
}

/// Points of a test, from the origin on: (strain or angle, force), both ascending strictly. The origin need
/// not be among them.
using MeasuredCurve = std::vector<Vec2>;

/// The stiffness of a limit grows as 1/(limit − 1) (energy/stretch_limit.hpp) without bound: a limit a
/// rounding error above 1 asks for 1e16 times the weight of the cloth. At this one, a millimetre in a metre,
/// it is five times that of 1.005, and the range in which it rises is still far above rounding.
constexpr double least_stretch_limit = 1.001;

struct ShellMaterial {
  double areal_density = 0;                  ///< [kg/m²]
  double membrane_warp = 0;                  ///< force per width and strain along warp [N/m]
  double membrane_weft = 0;                  ///< [N/m]
  double membrane_shear = 0;                 ///< force per width and radian [N/m]
  std::optional<MeasuredCurve> warp_curve;   ///< in place of membrane_warp: (strain, force per width [N/m])
  std::optional<MeasuredCurve> weft_curve;   ///< in place of membrane_weft
  std::optional<MeasuredCurve> shear_curve;  ///< in place of membrane_shear: (angle [degrees], force [N/m])
  double poisson = 0;                        ///< of stretch and of bending, geometric mean of both directions
  double bending_warp = 0;                   ///< moment per width and curvature, bending warp [N·m]
  double bending_weft = 0;                   ///< [N·m]
  double bending_bias = 0;                   ///< at 45° between them [N·m]
  /// In place of bending_warp: (curvature [1/m], moment per width [N]).
  std::optional<MeasuredCurve> bending_warp_curve;
  std::optional<MeasuredCurve> bending_weft_curve;  ///< in place of bending_weft
  double bending_friction_warp = 0;                 ///< greatest moment per width of internal friction [N]
  double bending_friction_weft = 0;                 ///< [N]
  double bending_friction_curvature = 10;           ///< over which it builds up [1/m]
  std::optional<double> yield_curvature;  ///< elastic curvature of warp beyond which creases stay [1/m]
  double yield_hardening = 0;             ///< rigidity beyond yield over that below, 0 … 1
  std::optional<double> yield_recovery;   ///< time in which creases fade to 1/e of themselves [s]
  std::optional<double> yield_strain;     ///< of a pulled thread beyond which it stays longer
  double strain_hardening = 0;            ///< stiffness beyond it over that below, 0 … 1
  std::optional<double> stretch_limit;              ///< of bodies that have none of their own
  double mass_damping = 0;                          ///< Rayleigh α [1/s]
  double stiffness_damping = 0;                     ///< Rayleigh β of stretch and shear [s]
  double bending_damping = 0;                       ///< Rayleigh β of bending [s]
  schema::Variations variations;                    ///< of those numbers above that vary
};

/// The table [shell] of a material file. Required, unless there is a `base` beside them, are areal_density,
/// membrane_warp or warp_curve, and bending_warp or its curve. Unless given, weft equals warp, shear is that
/// of an isotropic sheet, bias lies between warp and weft, and bending_damping equals stiffness_damping. A
/// bias so low that the sheet would not resist twisting is an error, and so is a Poisson's ratio with which
/// curves make an unstable sheet.
const schema::Table& shell_material_table();

}  // namespace muslin
