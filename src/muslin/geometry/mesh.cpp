#include "muslin/geometry/mesh.hpp"

#include <algorithm>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/ear_clipping.hpp"

namespace muslin {

void Mesh::add_face(std::span<const int> vertices) {
  if (vertices.size() < 3)
    throw Error(ErrorKind::usage, "a face has " + std::to_string(vertices.size()) + " corners",
                "give at least three");
  if (face_offsets.empty()) face_offsets.push_back(0);
  face_vertices.insert(face_vertices.end(), vertices.begin(), vertices.end());
  face_offsets.push_back(static_cast<int>(face_vertices.size()));
  if (!corner_uvs.empty()) corner_uvs.resize(face_vertices.size(), -1);
}

std::vector<int> Mesh::material_of_face() const {
  std::vector<int> of_face(face_count(), -1);
  for (std::size_t m = 0; m < materials.size(); ++m)
    for (const int f : materials[m].faces) of_face[static_cast<std::size_t>(f)] = static_cast<int>(m);
  return of_face;
}

Box Mesh::bounds() const {
  Box box;
  if (face_vertices.empty())
    for (const Vec3& position : positions) box.extend(position);
  for (const int vertex : face_vertices) box.extend(positions[static_cast<std::size_t>(vertex)]);
  return box;
}

MeshCut cut(const Mesh& mesh, std::span<const std::array<int, 2>> edges) {
  TopologyChange change = cut(static_cast<const Topology&>(mesh), mesh.vertex_count(), edges);
  MeshCut result{mesh, std::move(change.origins)};
  static_cast<Topology&>(result.mesh) = std::move(change.topology);
  for (std::size_t v = mesh.vertex_count(); v < result.origins.size(); ++v) {
    const int origin = result.origins[v];
    result.mesh.positions.push_back(mesh.positions[static_cast<std::size_t>(origin)]);
    for (MeshGroup& group : result.mesh.groups) {
      if (std::binary_search(group.vertices.begin(), group.vertices.end(), origin))
        group.vertices.push_back(static_cast<int>(v));
    }
  }
  return result;
}

Vec3 newell_normal(ConstVectors positions, std::span<const int> face) {
  // Uses differences to one corner, so that a small polygon far from the origin keeps its digits.
  const Vec3& origin = positions[static_cast<std::size_t>(face[0])];
  Vec3 sum = Vec3::Zero();
  Vec3 previous = positions[static_cast<std::size_t>(face[1])] - origin;
  for (std::size_t c = 2; c < face.size(); ++c) {
    const Vec3 next = positions[static_cast<std::size_t>(face[c])] - origin;
    sum += previous.cross(next);
    previous = next;
  }
  return sum;
}

Triangulation triangulate(const Mesh& mesh) {
  Triangulation result;
  const std::size_t faces = mesh.face_count();
  if (faces == 0) return result;
  const std::size_t triangles = mesh.face_vertices.size() - 2 * faces;
  result.triangles.resize(triangles);
  result.faces.resize(triangles);
  // Face f owns the triangles from face_offsets[f] − 2f on, so the faces can be cut in any order.
  parallel_for(faces, 4096, [&](std::size_t begin, std::size_t end) {
    EarClipping clipping;
    for (std::size_t f = begin; f < end; ++f) {
      const std::span<const int> face = mesh.face(f);
      const std::size_t first = static_cast<std::size_t>(mesh.face_offsets[f]) - 2 * f;
      const std::span<Vec3i> out{result.triangles.data() + first, face.size() - 2};
      if (face.size() == 3)
        out[0] = {face[0], face[1], face[2]};
      else
        clipping.cut(mesh.positions, face, out);
      std::fill_n(result.faces.begin() + static_cast<std::ptrdiff_t>(first), out.size(), static_cast<int>(f));
    }
  });
  return result;
}

}  // namespace muslin
