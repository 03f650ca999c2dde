// Reads STL, ASCII and binary; its separate triangles are welded by position.
#pragma once

#include <string>
#include <string_view>

#include "muslin/io/mesh_file.hpp"

namespace muslin {

/// `file` is for messages. Several solids of an ASCII file become groups. Errors: input, with the line of an
/// ASCII file or the number of the triangle.
MeshFile read_stl(std::string_view bytes, const std::string& file);

}  // namespace muslin
