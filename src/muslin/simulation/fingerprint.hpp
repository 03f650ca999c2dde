// Computes the fingerprint by which a saved state is matched to a model.
#pragma once

#include <cstdint>

#include "muslin/scene/model.hpp"

namespace muslin {

/// Returns a hash of the data that a state must fit: the vertices at rest, their masses, and the bodies'
/// lattices and materials. Pins, loads, times and solver settings are not included: a run may continue with
/// others.
std::uint64_t model_fingerprint(const Model& model);

}  // namespace muslin
