// validate checks scenes that a program has made. Scenes read from a file have been checked already, with the
// place of each number.
#pragma once

#include "muslin/api.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {

/// Returns if build_model can build the scene as far as its settings are concerned: numbers are finite and
/// within the ranges of the scene file, names are unique, what is named exists, what a model needs is given.
/// Meshes are checked where they are read. Errors: input, for the first setting that is wrong, naming it.
MUSLIN_API void validate(const Scene& scene);

}  // namespace muslin
