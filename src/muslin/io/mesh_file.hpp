// Reads and writes mesh files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// A number at every vertex, as painted in a modeller.
struct VertexAttribute {
  std::string name;
  std::vector<double> values;  ///< #V, as in the file; may be NaN
};

/// Reads .obj, .ply, .stl, .gltf, .glb, .dae, .fbx; the content must match the suffix. Positions are in
/// double; polygons, vertex order, texture seams and groups are as in the file. The mesh passes
/// require_usable. Formats that store corners apart (STL, glTF, FBX, Collada) are welded by position, and
/// `note` says so. Errors: file, if it cannot be read; input, if it is malformed, with file and line if
/// known.
struct MeshFile {
  Mesh mesh;
  std::string note = {};  ///< changes made by the reader, empty if none
  /// Numbers at the vertices: further properties of a PLY file, of which one-byte ones are divided by 255;
  /// `red`, `green`, `blue` of an OBJ file with colours; of a glTF file the same, and `alpha`, from COLOR_0,
  /// and attributes that begin with `_`, components of vectors as `_NAME.x`. Where glTF stores a vertex
  /// several times it has their mean, and NaN where a part of the mesh lacks the attribute.
  std::vector<VertexAttribute> attributes = {};
};
MUSLIN_API MeshFile read_mesh(const std::filesystem::path& path);

/// Reads a mesh from memory. `suffix`, with its dot, names the format, `file` is for messages; external
/// buffers of a .gltf are searched in `folder`, and refused if that is empty.
MUSLIN_API MeshFile read_mesh_from(std::string_view bytes, const std::string& suffix, const std::string& file,
                                   const std::filesystem::path& folder = {});

/// Writes .obj or .ply by suffix, with polygons and vertex order, and in .obj texture coordinates and groups.
/// The file is written under a temporary name and renamed, so that a full disk leaves no broken file. Errors:
/// file.
MUSLIN_API void write_mesh(const std::filesystem::path& path, const Mesh& mesh);
MUSLIN_API void write_mesh(const std::filesystem::path& path, const Mesh& mesh, ConstVectors positions);

}  // namespace muslin
