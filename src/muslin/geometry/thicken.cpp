#include "muslin/geometry/thicken.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/error.hpp"
#include "muslin/geometry/orientation.hpp"

namespace muslin {
namespace {

constexpr double miter_limit = 2;

// Returns the unit normal of a polygon by Newell's sum; zero if it has no area.
Vec3 polygon_normal(const Mesh& mesh, std::span<const int> face) {
  const Vec3& origin = mesh.positions[static_cast<std::size_t>(face[0])];
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < face.size(); ++i)
    sum += (mesh.positions[static_cast<std::size_t>(face[i])] - origin)
               .cross(mesh.positions[static_cast<std::size_t>(face[i + 1])] - origin);
  const double length = sum.norm();
  return length > 0 ? Vec3(sum / length) : Vec3::Zero();
}

// Returns the inner angle at corner i of a polygon, up to 2π where it is concave.
double inner_angle(const Mesh& mesh, std::span<const int> face, std::size_t i, const Vec3& normal) {
  const std::size_t n = face.size();
  const auto position = [&](std::size_t k) -> const Vec3& {
    return mesh.positions[static_cast<std::size_t>(face[k % n])];
  };
  const Vec3 next = position(i + 1) - position(i);
  const Vec3 previous = position(i + n - 1) - position(i);
  const double angle = std::atan2(next.cross(previous).dot(normal), next.dot(previous));
  return angle < 0 ? angle + 2 * EIGEN_PI : angle;
}

/// Returns the texture coordinates of the corners of a thickened mesh, whose faces are the two sides of each
/// face of the mesh and then the walls.
std::vector<int> uvs_of_solid(const Mesh& mesh, const Patches& patches, std::span<const EdgeUse> rim) {
  std::vector<int> result;
  if (mesh.corner_uvs.empty()) return result;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<int> face(mesh.corner_uvs.begin() + mesh.face_offsets[f],
                          mesh.corner_uvs.begin() + mesh.face_offsets[f + 1]);
    if (patches.turned[f] != 0) std::reverse(face.begin(), face.end());
    result.insert(result.end(), face.begin(), face.end());
    result.insert(result.end(), face.rbegin(), face.rend());
  }
  for (const EdgeUse& use : rim) {
    int from = mesh.corner_uvs[static_cast<std::size_t>(use.corner)];
    int to = mesh.corner_uvs[static_cast<std::size_t>(mesh.next_corner(use.face, use.corner))];
    if (patches.turned[static_cast<std::size_t>(use.face)] != 0) std::swap(from, to);
    result.insert(result.end(), {to, from, from, to});
  }
  return result;
}

/// `upper` is the upper copy of each corner's vertex.
MeshGroup group_of_solid(const Mesh& mesh, const MeshGroup& group, const std::vector<int>& upper,
                         std::span<const EdgeUse> rim) {
  MeshGroup result{group.name, {}, {}};
  for (const int f : group.faces) result.faces.insert(result.faces.end(), {2 * f, 2 * f + 1});
  for (std::size_t r = 0; r < rim.size(); ++r)
    if (std::binary_search(group.faces.begin(), group.faces.end(), rim[r].face))
      result.faces.push_back(static_cast<int>(2 * mesh.face_count() + r));
  for (std::size_t c = 0; c < upper.size(); ++c)
    if (std::binary_search(group.vertices.begin(), group.vertices.end(), mesh.face_vertices[c]))
      result.vertices.insert(result.vertices.end(), {upper[c], upper[c] + 1});
  std::sort(result.vertices.begin(), result.vertices.end());
  result.vertices.erase(std::unique(result.vertices.begin(), result.vertices.end()), result.vertices.end());
  return result;
}

}  // namespace

bool is_closed(const Mesh& mesh) {
  bool closed = mesh.face_count() > 0;
  for_each_edge(edge_uses(mesh), [&](std::span<const EdgeUse> edge) { closed = closed && edge.size() > 1; });
  return closed;
}

Mesh thicken(const Mesh& mesh, double thickness) {
  if (!(thickness > 0) || !std::isfinite(thickness))
    throw Error(ErrorKind::usage, "a sheet has the thickness " + std::to_string(thickness) + " m",
                "give a positive thickness in metres");
  const std::size_t face_count = mesh.face_count();
  const std::vector<EdgeUse> uses = edge_uses(mesh);
  const Patches patches = find_patches(uses, face_count);
  const auto turned = [&](int f) { return patches.turned[static_cast<std::size_t>(f)] != 0; };
  const auto orientable = [&](int f) {
    return patches.orientable[static_cast<std::size_t>(patches.patch[static_cast<std::size_t>(f)])] != 0;
  };
  const auto following = [&](const EdgeUse& use) { return mesh.next_corner(use.face, use.corner); };

  // Find the corners that move together and the sides of faces that need a wall.
  DisjointSets sets(mesh.face_vertices.size());
  for (std::size_t f = 0; f < face_count; ++f) {
    const std::span<const int> face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {  // a vertex named twice in a row has no side between
      const std::size_t next = i + 1 < face.size() ? i + 1 : 0;
      if (face[i] == face[next])
        sets.join(mesh.face_offsets[f] + static_cast<int>(i), mesh.face_offsets[f] + static_cast<int>(next));
    }
  }
  std::vector<EdgeUse> rim;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2 && edge[0].face != edge[1].face && orientable(edge[0].face)) {
      const bool same_way = edge[0].ascends == edge[1].ascends;
      sets.join(edge[0].corner, same_way ? edge[1].corner : following(edge[1]));
      sets.join(following(edge[0]), same_way ? following(edge[1]) : edge[1].corner);
    } else {
      rim.insert(rim.end(), edge.begin(), edge.end());
    }
  });

  std::vector<Vec3> normal_sum(mesh.face_vertices.size(), Vec3::Zero());
  std::vector<double> angle_sum(mesh.face_vertices.size(), 0);
  for (std::size_t f = 0; f < face_count; ++f) {
    const std::span<const int> face = mesh.face(f);
    const Vec3 normal = polygon_normal(mesh, face);
    if (normal.isZero(0)) continue;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const int set = sets.find(mesh.face_offsets[f] + static_cast<int>(i));
      const double angle = inner_angle(mesh, face, i, normal);
      normal_sum[static_cast<std::size_t>(set)] +=
          turned(static_cast<int>(f)) ? -angle * normal : angle * normal;
      angle_sum[static_cast<std::size_t>(set)] += angle;
    }
  }

  // Vertices 2s and 2s+1 of the result are the upper and lower copy of the s-th set of corners.
  Mesh solid;
  solid.name = mesh.name;
  std::vector<int> upper(mesh.face_vertices.size(), -1);
  for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
    const auto set = static_cast<std::size_t>(sets.find(static_cast<int>(c)));
    if (set == c) {
      // The faces' mean cosine with the vertex normal is |Σ angle·normal| / Σ angle.
      const double length = normal_sum[set].norm();
      Vec3 offset = Vec3::Zero();
      if (length > 0) {
        const double miter = std::min(angle_sum[set] / length, miter_limit);
        offset = 0.5 * thickness * miter * (normal_sum[set] / length);
      }
      const Vec3& position = mesh.positions[static_cast<std::size_t>(mesh.face_vertices[c])];
      upper[c] = static_cast<int>(solid.positions.size());
      solid.positions.push_back(position + offset);
      solid.positions.push_back(position - offset);
    } else {
      upper[c] = upper[set];  // a set is named after its first corner
    }
  }

  std::vector<int> polygon;
  for (std::size_t f = 0; f < face_count; ++f) {
    polygon.assign(upper.begin() + mesh.face_offsets[f], upper.begin() + mesh.face_offsets[f + 1]);
    if (turned(static_cast<int>(f))) std::reverse(polygon.begin(), polygon.end());
    solid.add_face(polygon);
    for (int& vertex : polygon) ++vertex;
    std::reverse(polygon.begin(), polygon.end());
    solid.add_face(polygon);
  }
  for (const EdgeUse& use : rim) {
    int from = upper[static_cast<std::size_t>(use.corner)],
        to = upper[static_cast<std::size_t>(following(use))];
    if (turned(use.face)) std::swap(from, to);
    solid.add_face(std::array{to, from, from + 1, to + 1});
  }
  solid.uvs = mesh.uvs;
  solid.corner_uvs = uvs_of_solid(mesh, patches, rim);
  for (const MeshMaterial& material : mesh.materials) solid.materials.push_back({material.name, {}});
  const std::vector<int> materials = mesh.material_of_face();
  const auto give_material = [&](int f, std::size_t of_solid) {
    const int material = materials[static_cast<std::size_t>(f)];
    if (material < 0) return;
    solid.materials[static_cast<std::size_t>(material)].faces.push_back(static_cast<int>(of_solid));
  };
  for (std::size_t f = 0; f < 2 * face_count; ++f) give_material(static_cast<int>(f / 2), f);
  for (std::size_t w = 0; w < rim.size(); ++w) give_material(rim[w].face, 2 * face_count + w);
  for (const MeshGroup& group : mesh.groups) solid.groups.push_back(group_of_solid(mesh, group, upper, rim));
  return solid;
}

}  // namespace muslin
