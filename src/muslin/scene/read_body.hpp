// Reads a [[body]].
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "muslin/core/toml_value.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {

/// The stiffness of a limit grows as 1/(limit − 1) (energy/stretch_limit.hpp) without bound: a limit a
/// rounding error above 1 asks for 1e16 times the weight of the cloth. At this one, a millimetre in a metre,
/// it is five times that of low_stretch_limit, and the range in which it rises is still far above rounding.
inline constexpr double least_stretch_limit = 1.001;

/// `index` counts the bodies from 0; `folder` is that of the scene file, for material files. Appends warnings
/// about settings that are legal but probably unintended. Errors: input, file.
BodySettings read_body(const TomlValue& value, std::size_t index, const std::filesystem::path& folder,
                       std::vector<std::string>& warnings);

}  // namespace muslin
