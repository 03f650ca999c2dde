// Builds the pins and probes of the model from those of the scene.
#pragma once

#include "muslin/scene/model.hpp"

namespace muslin {

/// Add the pins and the probes of model.scene to `model`, whose components, rest positions and
/// masses already exist. Errors: input, with the place in the scene.
void build_pins(Model& model);
void build_probes(Model& model);

/// Warns of soft pins that are stiffer than the material they hold, whose forces steps do not resolve. The
/// terms of the components exist.
void warn_of_stiff_pins(Model& model);

}  // namespace muslin
