// Reads a [[collider]] and [contact].
#pragma once

#include <cstddef>

#include "muslin/core/toml_table.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {

/// `index` counts the colliders from 0. Errors: input.
ColliderSettings read_collider(const TomlValue& value, std::size_t index);

/// Reads [contact] of the scene, with defaults if there is none. Errors: input.
ContactSettings read_contact(const TomlTable& top);

}  // namespace muslin
