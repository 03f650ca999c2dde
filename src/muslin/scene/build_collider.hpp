// Builds a body from the settings of a collider: a mesh for pictures, and its motion.
#pragma once

#include <string>
#include <vector>

#include "muslin/scene/model.hpp"

namespace muslin {

struct BuiltCollider {
  Body body;
  Prescribed motion;  ///< of its vertices, if it has no density; `first` is 0
};

/// Builds all of Body except its vertex range in the model. `around` is the box of the other bodies at the
/// start: a plane, which is unbounded, is shown somewhat beyond it. Appends to `warnings`. Errors: input and
/// file, with the place in the scene and the mesh file.
BuiltCollider build_collider(const Scene& scene, const ColliderSettings& settings, const Box& around,
                             std::vector<std::string>& warnings);

/// Returns points of the body as combinations of its four control vertices.
Embedding embed(const AffineFrame& frame, ConstVectors points);

}  // namespace muslin
