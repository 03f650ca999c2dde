// Converts meshes to the bytes of a file.
#pragma once

#include <string>

#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// `positions` replace those of the mesh: shape (#V by 3). Numbers are the shortest that read back exactly.
/// Reading the text with read_obj gives vertex order, polygons, texture indices and groups back; vertices of
/// a group outside its faces are written as points.
std::string to_obj(const Mesh& mesh, ConstVectors positions);

/// Returns binary little-endian PLY, positions in double.
std::string to_ply(const Mesh& mesh, ConstVectors positions);

}  // namespace muslin
