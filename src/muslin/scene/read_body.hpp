// Reads a [[body]].
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "muslin/core/toml_value.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {

/// `index` counts the bodies from 0; `folder` is that of the scene file, for material files. Appends warnings
/// about settings that are legal but probably unintended. Errors: input, file.
BodySettings read_body(const TomlValue& value, std::size_t index, const std::filesystem::path& folder,
                       std::vector<std::string>& warnings);

}  // namespace muslin
