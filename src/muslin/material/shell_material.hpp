// ShellMaterial holds the material data of a shell, per area and per width, as fabrics are measured.
#pragma once

#include <string>
#include <vector>

#include "muslin/api.hpp"

namespace muslin {

class TomlTable;

struct ShellMaterial {
  double areal_density = 0;      ///< [kg/m²]
  double membrane_warp = 0;      ///< force per width and strain along warp [N/m]
  double membrane_weft = 0;      ///< [N/m]
  double membrane_shear = 0;     ///< force per width and radian [N/m]
  double poisson = 0;            ///< geometric mean of both directions
  double bending_warp = 0;       ///< moment per width and curvature, bending warp [N·m]
  double bending_weft = 0;       ///< [N·m]
  double bending_bias = 0;       ///< at 45° between them [N·m]
  double mass_damping = 0;       ///< Rayleigh α [1/s]
  double stiffness_damping = 0;  ///< Rayleigh β of stretch and shear [s]
  double bending_damping = 0;    ///< Rayleigh β of bending [s]
};

/// Returns areal_density, membrane_warp, …: the keys of a table of shell numbers.
MUSLIN_API const std::vector<std::string>& shell_material_keys();

/// Returns the numbers given in `table`, else those of `base`. Without a base areal_density, membrane_warp
/// and bending_warp are required; weft is as warp, shear as in an isotropic sheet, bias between warp and
/// weft, bending_damping as stiffness_damping, unless given. Errors: input, also for a bias so low that some
/// direction between would have a negative rigidity.
ShellMaterial read_shell_material(const TomlTable& table, const ShellMaterial* base = nullptr);

}  // namespace muslin
