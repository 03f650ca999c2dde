// Reads PLY (G. Turk, "The PLY polygon file format", Stanford 1994), ASCII and binary of either byte order.
#pragma once

#include <string>
#include <string_view>

#include "muslin/io/mesh_file.hpp"

namespace muslin {

/// `file` is for messages. Texture coordinates: s t, u v, texture_u texture_v per vertex, or a list
/// `texcoord` per face. Other elements and properties are ignored. Errors: input, with the line in ASCII
/// files.
MeshFile read_ply(std::string_view bytes, const std::string& file);

}  // namespace muslin
