// Reading a [[body]].
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "muslin/core/toml_value.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {

/// `index` counts the bodies from 0; `folder` is that of the scene file, for materials in files of their own.
/// Appends to `warnings` what is legal but probably not meant. Errors: input, file.
BodySettings read_body(const TomlValue& value, std::size_t index, const std::filesystem::path& folder,
                       std::vector<std::string>& warnings);

/// Names of bodies, pins, … end up in file names and paths: not empty, no separators or control characters.
/// Throws Error(input) if `name` is no such name.
void require_name(const std::string& name, const Place& place);

}  // namespace muslin
