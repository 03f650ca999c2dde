// The quantities of a material as keys of a TOML table: in a material file and in a scene.
#pragma once

#include <string>
#include <vector>

#include "muslin/core/toml_table.hpp"
#include "muslin/material/material.hpp"

namespace muslin {

/// density, edge_modulus, …: the keys of the quantities of Material.
const std::vector<std::string>& material_keys();

/// Puts the quantities that `table` has into `material`. Errors: input, for wrong values.
void read_material_keys(const TomlTable& table, Material& material);

}  // namespace muslin
