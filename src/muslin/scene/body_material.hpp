// Declares and reads `material` of a [[body]]: a name, a file, or a table.
#pragma once

#include <filesystem>

#include "muslin/scene/scene.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {

// Return the key for each model, of BodySettings. The keys check and write the material; read_body_material
// reads it.
schema::Declaration lattice_material_key();
schema::Declaration shell_material_key();

/// Reads the material under `material` of a body, whose other settings have been read. `folder` is the scene
/// file's folder. Errors: input, file.
void read_body_material(const TomlTable& table, const std::filesystem::path& folder, BodySettings& body);

}  // namespace muslin
