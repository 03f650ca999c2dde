// Declares [[collider]]: what every collider has, and a table of further keys for each shape.
#pragma once

#include <cstddef>

#include "muslin/scene/scene.hpp"
#include "muslin/schema/table.hpp"

namespace muslin {

const schema::Table& collider_table();  ///< of ColliderSettings

/// Completes a collider that was read from `table` with what depends on the scene. Errors: input.
void finish_collider(const TomlTable& table, std::size_t index, ColliderSettings& collider,
                     const Scene& scene);

}  // namespace muslin
