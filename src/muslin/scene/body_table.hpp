// Declares [[body]]: what every body has, and a table of further keys for each model.
#pragma once

#include <cstddef>

#include "muslin/scene/scene.hpp"
#include "muslin/schema/table.hpp"

namespace muslin {

const schema::Table& body_table();  ///< of BodySettings

/// Completes a body that was read from `table`: its name and its material, which may be in a file beside the
/// scene. Appends warnings about settings that are legal but probably unintended. Errors: input, file.
void finish_body(const TomlTable& table, BodySettings& body, Scene& scene);

}  // namespace muslin
