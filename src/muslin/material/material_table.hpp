// Declares the numbers of a lattice's material.
#pragma once

#include "muslin/schema/table.hpp"

namespace muslin {

/// The table [lattice] of a material file; its settings are a Material.
const schema::Table& lattice_material_table();

}  // namespace muslin
