// Reads `where`.
#pragma once

#include "muslin/core/toml_table.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {

/// Returns the selection under the key `where` of a pin or force. Errors: input; also if it has no criterion.
Selection read_selection(const TomlTable& owner);

}  // namespace muslin
