#include "muslin/io/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/io/assimp_reader.hpp"
#include "muslin/io/gltf_reader.hpp"
#include "muslin/io/mesh_writers.hpp"
#include "muslin/io/obj_reader.hpp"
#include "muslin/io/ply_reader.hpp"
#include "muslin/io/stl_reader.hpp"

namespace muslin {
namespace {

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

struct Signature {
  std::string_view bytes, suffix, name;
};
// First bytes of other file kinds; an empty suffix matches no supported one.
constexpr std::array signatures = {
    Signature{"\x89PNG", "", "a PNG picture"},
    Signature{"\xFF\xD8\xFF", "", "a JPEG picture"},
    Signature{"GIF8", "", "a GIF picture"},
    Signature{"%PDF", "", "a PDF document"},
    Signature{"PK\x03\x04", "", "a ZIP archive"},
    Signature{"\x1F\x8B", "", "a gzip archive"},
    Signature{"BLENDER", "", "a Blender scene"},
    Signature{"\x7F"
              "ELF",
              "", "a program"},
    Signature{"\xFF\xFE", "", "UTF-16 text"},
    Signature{"\xFE\xFF", "", "UTF-16 text"},
    Signature{"glTF", ".glb", "a binary glTF file"},
    Signature{"ply\n", ".ply", "a PLY file"},
    Signature{"ply\r", ".ply", "a PLY file"},
    Signature{"Kaydara FBX", ".fbx", "an FBX file"},
};

void check_signature(std::string_view bytes, const std::string& suffix, const std::string& file) {
  for (const Signature& signature : signatures) {
    if (!bytes.starts_with(signature.bytes) || suffix == signature.suffix) continue;
    if (suffix == ".gltf" && signature.suffix == ".glb") continue;  // distinguished by the reader
    throw Error(ErrorKind::input, Place{file},
                "the content is " + std::string(signature.name) + ", not " + suffix,
                signature.suffix.empty() ? "give a mesh file"
                                         : "rename it to end in " + std::string(signature.suffix));
  }
  const bool text = suffix == ".obj" || suffix == ".gltf" || suffix == ".dae";
  if (text && bytes.substr(0, 4096).find('\0') != bytes.npos && !bytes.starts_with("glTF"))
    throw Error(ErrorKind::input, Place{file}, "the content is binary, not the text of a " + suffix + " file",
                "give the file the suffix of its real format, or export it again");
}

}  // namespace

MeshFile read_mesh_from(std::string_view bytes, const std::string& suffix, const std::string& file,
                        const std::filesystem::path& folder) {
  const std::string kind = lower(suffix);
  if (kind != ".obj" && kind != ".ply" && kind != ".stl" && kind != ".gltf" && kind != ".glb" &&
      kind != ".dae" && kind != ".fbx")
    throw Error(ErrorKind::input, Place{file},
                kind.empty() ? "the file has no suffix" : "files ending in " + kind + " are not known",
                "use .obj, .ply, .stl, .gltf, .glb, .dae or .fbx");
  if (bytes.find_first_not_of(" \t\r\n") == bytes.npos)
    throw Error(ErrorKind::input, Place{file}, "the file is empty", "export the mesh again");
  check_signature(bytes, kind, file);
  try {
    MeshFile result = kind == ".obj"                      ? read_obj(bytes, file)
                      : kind == ".ply"                    ? read_ply(bytes, file)
                      : kind == ".stl"                    ? read_stl(bytes, file)
                      : kind == ".gltf" || kind == ".glb" ? read_gltf(bytes, file, folder)
                                                          : read_with_assimp(bytes, kind, file);
    require_usable(result.mesh, file);
    return result;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::input, Place{file}, "the mesh is too large for this machine's memory", "split it");
  }
}

MeshFile read_mesh(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  return read_mesh_from(bytes, path.extension().string(), path.string(), folder);
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh) {
  write_mesh(path, mesh, mesh.positions);
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh, ConstVectors positions) {
  if (positions.size() != mesh.positions.size())
    throw Error(ErrorKind::usage, Place{path.string()},
                std::to_string(positions.size()) + " positions for a mesh of " +
                    std::to_string(mesh.positions.size()) + " vertices",
                "give one per vertex");
  const std::string suffix = lower(path.extension().string());
  if (suffix == ".obj")
    write_atomically(path, to_obj(mesh, positions));
  else if (suffix == ".ply")
    write_atomically(path, to_ply(mesh, positions));
  else
    throw Error(ErrorKind::file, Place{path.string()}, "meshes are not written as '" + suffix + "'",
                "let the name end in .obj or .ply");
}

}  // namespace muslin
