// Reads the quantities of a material from keys of a TOML table, in a material file or a scene.
#pragma once

#include <string>
#include <vector>

#include "muslin/core/toml_table.hpp"
#include "muslin/material/material.hpp"

namespace muslin {

/// Returns density, edge_modulus, …: the keys of the quantities of Material.
const std::vector<std::string>& material_keys();

/// Stores the quantities given in `table` in `material`. Errors: input, for wrong values.
void read_material_keys(const TomlTable& table, Material& material);

}  // namespace muslin
