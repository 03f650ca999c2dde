// The scene with every setting spelled out.
#pragma once

#include <string>

#include "muslin/scene/scene.hpp"

namespace muslin {

/// JSON of every setting with its value, defaults included, by the words of the scene file. Times without
/// end are null.
std::string resolved_json(const Scene& scene);

}  // namespace muslin
