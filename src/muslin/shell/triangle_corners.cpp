#include "muslin/shell/triangle_corners.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/core/index.hpp"

namespace muslin {
namespace {

constexpr double least_height = 1e-9;  // of a triangle in the texture, over its sides

}  // namespace

std::vector<Vec3i> triangle_corners(const Mesh& mesh, const Triangulation& cut) {
  std::vector<Vec3i> corners(cut.triangles.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    const auto f = at(cut.faces[t]);
    const auto face = mesh.face(f);
    for (int c = 0; c < 3; ++c) {
      const auto place = std::find(face.begin(), face.end(), cut.triangles[t][c]) - face.begin();
      corners[t][c] = mesh.face_offsets[f] + static_cast<int>(place);
    }
  }
  return corners;
}

double TextureTriangle::twice_area() const {
  const Vec2 u1 = uv[1] - uv[0], u2 = uv[2] - uv[0];
  return u1.x() * u2.y() - u1.y() * u2.x();
}

bool TextureTriangle::has_area() const {
  const Vec2 u1 = uv[1] - uv[0], u2 = uv[2] - uv[0];
  return std::abs(twice_area()) > least_height * std::max(u1.squaredNorm(), u2.squaredNorm());
}

std::optional<TextureTriangle> texture_of(const Mesh& mesh, const Vec3i& corners) {
  TextureTriangle triangle;
  for (int c = 0; c < 3; ++c) {
    const auto corner = at(corners[c]);
    const int index = corner < mesh.corner_uvs.size() ? mesh.corner_uvs[corner] : -1;
    if (index < 0) return std::nullopt;
    triangle.uv[at(c)] = mesh.uvs[at(index)];
  }
  return triangle;
}

std::vector<int> faces_without_texture(const Mesh& mesh) {
  const Triangulation cut = triangulate(mesh);
  const std::vector<Vec3i> corners = triangle_corners(mesh, cut);
  std::vector<int> faces;
  for (std::size_t t = 0; t < corners.size(); ++t) {
    const std::optional<TextureTriangle> texture = texture_of(mesh, corners[t]);
    if (texture && texture->has_area()) continue;
    if (faces.empty() || faces.back() != cut.faces[t]) faces.push_back(cut.faces[t]);
  }
  return faces;
}

}  // namespace muslin
