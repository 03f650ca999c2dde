// Declares [[force]]: what every force has, and a table of further keys for each type.
#pragma once

#include <cstddef>

#include "muslin/scene/scene.hpp"
#include "muslin/schema/table.hpp"

namespace muslin {

const schema::Table& force_table();  ///< of ForceSettings

/// Completes a force that was read from `table` with what depends on the scene. Errors: input.
void finish_force(const TomlTable& table, std::size_t index, ForceSettings& force, const Scene& scene);

}  // namespace muslin
