// Declares [[pin]].
#pragma once

#include <cstddef>

#include "muslin/scene/scene.hpp"
#include "muslin/schema/table.hpp"

namespace muslin {

const schema::Table& pin_table();  ///< of PinSettings

/// Completes a pin that was read from `table` with what depends on the scene. Errors: input.
void finish_pin(const TomlTable& table, std::size_t index, PinSettings& pin, const Scene& scene);

}  // namespace muslin
