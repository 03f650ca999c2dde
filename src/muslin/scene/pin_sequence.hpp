// Makes a pin follow a sequence of points.
#pragma once

#include "muslin/scene/model.hpp"

namespace muslin {

/// Reads the pin's sequence and sets the point that each held vertex follows: the point of the same number if
/// the body's vertices are those of its mesh; otherwise the vertex of the mesh that is nearest at rest, among
/// the pin's group if it has one. Errors: file; input, if the number of points differs from that of the
/// body's mesh.
void follow_sequence(const Scene& scene, const PinSettings& settings, const Component& body, Pin& pin);

}  // namespace muslin
