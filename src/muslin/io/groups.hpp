// Completes and names groups of a mesh under construction.
#pragma once

#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Adds the vertices of the group's faces to its vertices, and sorts both lists without duplicates.
void complete_group(const Mesh& mesh, MeshGroup& group);

/// Returns the name as one word, since a blank ends a name in OBJ: blanks and control characters become '_'.
std::string one_word(std::string_view name);

}  // namespace muslin
