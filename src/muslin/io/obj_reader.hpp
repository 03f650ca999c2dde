// Reads Wavefront OBJ as written: vertex order, polygons, texture seams, groups and objects.
#pragma once

#include <string>
#include <string_view>

#include "muslin/io/mesh_file.hpp"

namespace muslin {

/// `file` is for messages. One object with faces names the mesh; several become groups, as do `g` statements
/// (a face may belong to several). Points (`p`) make vertex groups. Normals, materials, lines and curves are
/// ignored. Errors: input, with line and column.
MeshFile read_obj(std::string_view text, const std::string& file);

}  // namespace muslin
