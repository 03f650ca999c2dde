// Tells whether a saved state belongs to a model.
#pragma once

#include <cstdint>

#include "muslin/scene/model.hpp"

namespace muslin {

/// Hash of what a state must fit: the vertices at rest, their masses, and the bodies' lattices and
/// materials. Pins, loads, times and solver settings are not in it: a run may go on with others.
std::uint64_t model_fingerprint(const Model& model);

}  // namespace muslin
