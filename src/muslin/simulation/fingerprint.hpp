// Hashes that tell whether a saved state belongs to a model.
#pragma once

#include <cstddef>
#include <cstdint>

#include "muslin/scene/model.hpp"

namespace muslin {

/// A 64-bit hash of the bytes (not cryptographic), the same on every machine.
std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0);

/// Hash of what a state must fit: the vertices at rest, their masses, and the bodies' lattices and
/// materials. Pins, loads, times and solver settings are not in it: a run may go on with others.
std::uint64_t model_fingerprint(const Model& model);

}  // namespace muslin
