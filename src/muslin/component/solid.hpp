// Classifies the solid that a mesh represents.
#pragma once

#include "muslin/geometry/inspect.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

enum class MeshKind {
  solid,        ///< closed, encloses a volume
  holed_solid,  ///< open, but its holes are small against its area: the winding number closes them
  sheet,        ///< open, or closed around nothing
};

/// An open mesh is a holed solid if flat lids over its boundary loops (of perimeter L, at most L²/4π each)
/// would add less than 2 % to its area. Openings of clothes are larger: the neck, sleeves and hem of a shirt
/// amount to about 8 %.
MeshKind kind_of(const Mesh& mesh, const MeshReport& report);

/// Returns the mesh with every face reversed.
Mesh flipped(Mesh mesh);

}  // namespace muslin
