#include "muslin/shell/rest_shape.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/shell/triangle_corners.hpp"

namespace muslin {
namespace {

/// Metres per unit of the texture with which the areas of mesh and texture agree, over the polygons that are
/// not bare.
double matching_scale(const Mesh& mesh, const std::vector<int>& bare) {
  const Triangulation cut = triangulate(mesh);
  const std::vector<Vec3i> corners = triangle_corners(mesh, cut);
  double modelled = 0, textured = 0;
  for (std::size_t t = 0; t < corners.size(); ++t) {
    if (std::binary_search(bare.begin(), bare.end(), cut.faces[t])) continue;
    const Vec3i& v = cut.triangles[t];
    const Vec3& x0 = mesh.positions[at(v[0])];
    modelled += (mesh.positions[at(v[1])] - x0).cross(mesh.positions[at(v[2])] - x0).norm();
    textured += std::abs(texture_of(mesh, corners[t])->twice_area());
  }
  return std::sqrt(modelled / textured);
}

}  // namespace

Vec3 RestShape::longest_side() const {
  Box bounds;
  for (const int corner : corners) bounds.extend(positions[at(corner)]);
  int axis;
  bounds.sizes().maxCoeff(&axis);
  return Vec3::Unit(axis);
}

std::vector<Vec3i> RestShape::triangles(std::vector<Vec3i> corners_of_triangles) const {
  for (Vec3i& triangle : corners_of_triangles)
    for (int& corner : triangle) corner = corners[at(corner)];
  return corners_of_triangles;
}

RestShape rest_of_vertices(const Mesh& mesh, ConstVectors positions) {
  require(positions.size() == mesh.vertex_count(),
          "a rest shape has another number of vertices than its mesh", "give one position for each");
  return {std::vector<Vec3>(positions.begin(), positions.end()), mesh.face_vertices};
}

RestShape rest_of_texture(const Mesh& mesh, std::optional<double> scale) {
  const std::vector<int> bare = faces_without_texture(mesh);
  if (bare.size() == mesh.face_count())
    throw Error(ErrorKind::input, "no polygon has an area in the texture, so it is no stress-free shape",
                "unwrap the mesh, or leave out `rest`");
  RestShape rest;
  rest.unfolded = true;
  rest.uv_scale = scale ? *scale : matching_scale(mesh, bare);
  for (const Vec2& uv : mesh.uvs)
    rest.positions.emplace_back(rest.uv_scale * uv.x(), rest.uv_scale * uv.y(), 0);
  rest.corners = mesh.corner_uvs;
  for (const int f : bare) {
    for (int c = mesh.face_offsets[at(f)]; c < mesh.face_offsets[at(f) + 1]; ++c) {
      rest.corners[at(c)] = static_cast<int>(rest.positions.size());
      rest.positions.push_back(mesh.positions[at(mesh.face_vertices[at(c)])]);
    }
  }
  return rest;
}

}  // namespace muslin
