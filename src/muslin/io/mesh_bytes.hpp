// Turns a mesh into bytes and back, to hand it from one process of muslin to another: the layout is that of
// this machine and version.
#pragma once

#include <string>
#include <string_view>

#include "muslin/io/mesh_file.hpp"

namespace muslin {

std::string to_bytes(const MeshFile& file);
/// Errors: input, if the bytes are too few.
MeshFile from_bytes(std::string_view bytes);

}  // namespace muslin
