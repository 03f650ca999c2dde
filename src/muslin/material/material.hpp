// What a body is made of.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace muslin {

/// Lattice material. A spring's constant is modulus × voxel width.
struct Material {
  std::string name;
  std::string source;                ///< where the numbers are from
  double density = 0;                ///< [kg/m³]
  double edge_modulus = 0;           ///< [N/m²]
  double face_diagonal_modulus = 0;  ///< [N/m²]
  double body_diagonal_modulus = 0;  ///< [N/m²]
  double volume_modulus = 0;         ///< stiffness of tetrahedral volume conservation [N/m²], 0: off
  double mass_damping = 0;           ///< Rayleigh α [1/s]
  double stiffness_damping = 0;      ///< Rayleigh β [s]
};

}  // namespace muslin
