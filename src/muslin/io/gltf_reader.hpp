// Reads glTF 2.0, text and binary, through tinygltf.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "muslin/io/mesh_file.hpp"

namespace muslin {

/// Returns all meshes of the scene with the transforms of their nodes. Vertices are welded by position within
/// a node; several nodes become groups. `file` is for messages; external buffers are searched in `folder`,
/// and refused if it is empty. Errors: input.
MeshFile read_gltf(std::string_view bytes, const std::string& file, const std::filesystem::path& folder);

}  // namespace muslin
