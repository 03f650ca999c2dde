// ShellMaterial holds the material data of a shell, per area and per width, as fabrics are measured.
#pragma once

namespace muslin {

namespace schema {
struct Table;
}

struct ShellMaterial {
  double areal_density = 0;      ///< [kg/m²]
  double membrane_warp = 0;      ///< force per width and strain along warp [N/m]
  double membrane_weft = 0;      ///< [N/m]
  double membrane_shear = 0;     ///< force per width and radian [N/m]
  double poisson = 0;            ///< of stretch and of bending, geometric mean of both directions
  double bending_warp = 0;       ///< moment per width and curvature, bending warp [N·m]
  double bending_weft = 0;       ///< [N·m]
  double bending_bias = 0;       ///< at 45° between them [N·m]
  double mass_damping = 0;       ///< Rayleigh α [1/s]
  double stiffness_damping = 0;  ///< Rayleigh β of stretch and shear [s]
  double bending_damping = 0;    ///< Rayleigh β of bending [s]
};

/// The table [shell] of a material file. areal_density, membrane_warp and bending_warp are required unless
/// there is a `base` beside them. Unless given, weft equals warp, shear is that of an isotropic sheet, bias
/// lies between warp and weft, and bending_damping equals stiffness_damping. A bias so low that the sheet
/// would not resist twisting is an error.
const schema::Table& shell_material_table();

}  // namespace muslin
