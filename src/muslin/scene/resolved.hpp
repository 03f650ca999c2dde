// Writes the scene with every setting made explicit.
#pragma once

#include <string>

#include "muslin/scene/scene.hpp"

namespace muslin {

/// Returns JSON of every setting with its value, defaults included, by the words of the scene file. Infinite
/// times are null.
std::string resolved_json(const Scene& scene);

}  // namespace muslin
