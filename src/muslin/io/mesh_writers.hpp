// Converts meshes to the bytes of a file.
#pragma once

#include <string>

#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// `positions` replace those of the mesh: shape (#V by 3). Numbers have the fewest digits that read back
/// exactly. read_obj restores vertex order, polygons, texture indices and groups from the text; vertices of a
/// group outside its faces are written as points.
std::string to_obj(const Mesh& mesh, ConstVectors positions);

/// Returns binary little-endian PLY, positions in double.
std::string to_ply(const Mesh& mesh, ConstVectors positions);

}  // namespace muslin
