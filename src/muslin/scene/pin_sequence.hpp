// Makes a pin follow a sequence of points.
#pragma once

#include "muslin/scene/model.hpp"

namespace muslin {

/// Reads the pin's sequence and sets the point that each held vertex follows: for a shell its own; for a
/// lattice the mesh vertex nearest at rest, of the pin's group if it has one. Errors: file; input, if the
/// number of points differs from that of the body's mesh.
void follow_sequence(const Scene& scene, const PinSettings& settings, const Body& body, Pin& pin);

}  // namespace muslin
