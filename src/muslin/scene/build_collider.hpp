// From the settings of a collider to a body: a mesh to look at, and what moves it.
#pragma once

#include <string>
#include <vector>

#include "muslin/scene/model.hpp"

namespace muslin {

struct BuiltCollider {
  Body body;
  Prescribed motion;  ///< of its vertices, if it has no density; `first` is 0
};

/// Everything of Body but its place among the vertices of the model. `around` is what the other bodies fill
/// at the start: a plane, which has no end, is shown as far as they reach and some way beyond. Appends to
/// `warnings`. Errors: input and file, with the place in the scene and the mesh file.
BuiltCollider build_collider(const Scene& scene, const ColliderSettings& settings, const Box& around,
                             std::vector<std::string>& warnings);

/// Points of the body as combinations of its four control vertices.
Embedding embed(const AffineFrame& frame, ConstVectors points);

}  // namespace muslin
