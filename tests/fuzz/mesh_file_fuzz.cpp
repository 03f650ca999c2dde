// Any bytes give a mesh that can be used or an Error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "muslin/core/error.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/io/mesh_writers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const muslin::Mesh mesh = muslin::read_mesh_from(bytes, FUZZED_SUFFIX, "fuzzed").mesh;
    muslin::inspect(mesh);
    const std::string obj = muslin::to_obj(mesh, mesh.positions);
    const muslin::Mesh again = muslin::read_mesh_from(obj, ".obj", "again").mesh;
    if (again.positions != mesh.positions || again.face_vertices != mesh.face_vertices ||
        again.corner_uvs != mesh.corner_uvs)
      __builtin_trap();
  } catch (const muslin::Error&) {
  }
  return 0;
}
