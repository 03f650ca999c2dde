// Material holds the material data of a body; muslin comes with a library of materials.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/material/shell_material.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin {

/// The quantities of a lattice, whose spring constants are modulus × voxel width, and those of a shell. A
/// material has at least one of the two.
struct Material {
  std::string name;
  std::string description;
  std::string source;                ///< source of the numbers
  std::vector<std::string> guesses;  ///< numbers that are not measured, such as "shell.bending_warp"
  bool has_lattice = true;           ///< the next twelve settings are valid
  double density = 0;                ///< [kg/m³]
  double edge_modulus = 0;           ///< [N/m²]
  double face_diagonal_modulus = 0;  ///< [N/m²]
  double body_diagonal_modulus = 0;  ///< [N/m²]
  double volume_modulus = 0;         ///< stiffness of tetrahedral volume conservation [N/m²], 0: off
  std::string law = "springs";  ///< of what fills a lattice: springs, or a solid of energy/solid_laws.hpp
  std::optional<double> youngs_modulus;  ///< E of a solid [N/m²]
  double poisson = 0.3;                  ///< ν of a solid
  std::optional<double> yield_strain;    ///< of springs, beyond which they keep another length
  double strain_hardening = 0;           ///< stiffness beyond it over that below, 0 … 1
  double mass_damping = 0;               ///< Rayleigh α [1/s]
  double stiffness_damping = 0;          ///< Rayleigh β [s]
  schema::Variations variations;         ///< of those numbers of the lattice that vary
  std::optional<ShellMaterial> shell;

  bool has_springs() const { return law == "springs"; }
  /// Measured numbers of the real material, for information only.
  std::vector<std::pair<std::string, double>> reference;
};

/// A number of a material, by its key in material and scene files.
struct MaterialNumber {
  std::string key;
  double value = 0;
  std::string unit;    ///< empty: none
  bool guess = false;  ///< among the guesses of the material
};
/// A measured curve of a material, by its key; `unit` names the units of both numbers of a point.
struct MaterialCurve {
  std::string key;
  MeasuredCurve points;
  std::string unit;
  bool guess = false;
};
/// Return the numbers and curves of the material for a lattice or a shell; empty if it has none.
std::vector<MaterialNumber> lattice_numbers(const Material& material);
std::vector<MaterialNumber> shell_numbers(const Material& material);
std::vector<MaterialCurve> shell_curves(const Material& material);

/// Returns the names of the materials that come with muslin, in alphabetical order. They are compiled into
/// the library.
MUSLIN_API std::vector<std::string> material_names();

/// Returns the material of this name. Errors: input, naming the nearest one.
MUSLIN_API Material find_material(const std::string& name);

/// Reads a material file: `name`, `description`, `source`, a list `guesses`, a table [lattice] and a table
/// [shell] with the quantities above, one of them or both, and a table [reference] of free numbers. Errors:
/// file; input with file, line and column.
MUSLIN_API Material read_material(const std::filesystem::path& file);
MUSLIN_API Material parse_material(std::string_view text, const std::string& file);

}  // namespace muslin
