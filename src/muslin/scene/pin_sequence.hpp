// A pin that moves as a sequence of points says.
#pragma once

#include "muslin/scene/model.hpp"

namespace muslin {

/// Reads the pin's sequence and says which of its points each held vertex follows: a shell's its own; a
/// lattice's the mesh vertex that is nearest at rest, of the pin's group if it has one. Errors: file; input,
/// if the sequence has not the points of the body's mesh.
void follow_sequence(const Scene& scene, const PinSettings& settings, const Body& body, Pin& pin);

}  // namespace muslin
