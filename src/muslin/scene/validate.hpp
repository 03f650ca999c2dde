// validate checks scenes that a program has made. Scenes read from a file were checked on reading, with the
// place of each value.
#pragma once

#include "muslin/api.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {

/// Throws Error(input), naming the setting, for the first setting that build_model cannot use: a number that
/// is not finite or outside the range of the scene file, a name that is not unique, a reference to a missing
/// name, or a missing required setting. Meshes are checked when they are read.
MUSLIN_API void validate(const Scene& scene);

}  // namespace muslin
