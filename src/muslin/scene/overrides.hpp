// Applies command-line settings that replace those of the scene file.
#pragma once

#include <string>

#include "muslin/core/toml_value.hpp"

namespace muslin {

/// Stores `setting`, a KEY=VALUE as given to --set, in the tree. KEY is a dotted path; an entry of a list of
/// tables is named by its number from 0 or by its `name`. VALUE is TOML; a bare word is a text. The value
/// gets "--set KEY=VALUE" as its place. Errors: usage, if it is not KEY=VALUE; input, if the path does not
/// exist.
void apply_override(TomlValue& scene, const std::string& setting);

}  // namespace muslin
