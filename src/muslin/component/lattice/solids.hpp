// Finds the solids of a mesh: parts connected by polygons that cross no other part and are not inside one.
#pragma once

#include <vector>

#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Returns #V: the smallest vertex of the part that is connected by polygons.
std::vector<int> parts_of(const Mesh& mesh);

/// Returns #V: the smallest vertex of the solid. Parts that cross each other are one solid, and so is a part
/// inside another, as the inner wall of a hollow ball.
std::vector<int> solids_of(const Mesh& mesh);

}  // namespace muslin
