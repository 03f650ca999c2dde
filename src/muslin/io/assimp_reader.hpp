// Reads Collada and FBX through assimp.
#pragma once

#include <string>
#include <string_view>

#include "muslin/io/mesh_file.hpp"

namespace muslin {

/// `suffix` is .dae or .fbx. Returns all nodes with their transforms, in metres and y up as far as the file
/// states units and axes. Vertices are welded by position, since assimp keeps neither vertex order nor seams.
/// Positions have the precision of float. Errors: input.
MeshFile read_with_assimp(std::string_view bytes, const std::string& suffix, const std::string& file);

}  // namespace muslin
