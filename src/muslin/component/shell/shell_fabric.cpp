#include "muslin/component/shell/shell_fabric.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/nearest_name.hpp"

namespace muslin {
namespace {

const std::vector<int>& faces_of(const ShellFabric& fabric, const Mesh& mesh) {
  std::vector<std::string> names;
  names.reserve(mesh.groups.size() + mesh.materials.size());
  for (const MeshGroup& group : mesh.groups) {
    if (!group.faces.empty()) names.push_back(group.name);
    if (group.name != fabric.faces) continue;
    if (!group.faces.empty()) return group.faces;
    throw Error(ErrorKind::input, fabric.place,
                fmt::format("the group `{}` of the mesh has vertices, but no faces", fabric.faces),
                "make a group of faces in the modeller, or give the faces a material");
  }
  for (const MeshMaterial& material : mesh.materials) {
    names.push_back(material.name);
    if (material.name == fabric.faces) return material.faces;
  }
  throw Error(ErrorKind::input, fabric.place,
              fmt::format("the mesh has no face group or material `{}`", fabric.faces),
              names.empty() ? "the mesh names no faces; export it as OBJ with groups or materials"
                            : name_advice(fabric.faces, names));
}

}  // namespace

FabricsOfFaces fabrics_of_faces(const Material& material, const Place& place,
                                const std::vector<ShellFabric>& fabrics, const Mesh& mesh) {
  FabricsOfFaces result;
  result.of_face.assign(mesh.face_count(), 0);
  result.fabrics.push_back({material.name, material, {}, {}, place, {}});
  for (const ShellFabric& fabric : fabrics) {
    const int index = static_cast<int>(result.fabrics.size());
    for (const int f : faces_of(fabric, mesh)) {
      int& of_face = result.of_face[static_cast<std::size_t>(f)];
      if (of_face != 0)
        throw Error(ErrorKind::input, fabric.place,
                    fmt::format("polygon {} belongs to the fabrics of `{}` and of `{}`", f + 1,
                                result.fabrics[static_cast<std::size_t>(of_face)].name, fabric.faces),
                    "give every polygon one fabric");
      of_face = index;
    }
    result.fabrics.push_back(
        {fabric.faces, fabric.material, fabric.friction, fabric.variations, fabric.place, {}});
  }
  if (std::find(result.of_face.begin(), result.of_face.end(), 0) == result.of_face.end()) {
    result.fabrics.erase(result.fabrics.begin());
    for (int& of_face : result.of_face) --of_face;
  }
  return result;
}

std::optional<double> largest_stretch_limit(const ShellMaterial& material) {
  const schema::Variation* variation = schema::find_variation(material.variations, "stretch_limit");
  if (variation == nullptr || !variation->is_map()) return material.stretch_limit;
  return variation->greatest();
}

}  // namespace muslin
