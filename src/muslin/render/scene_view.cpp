#include "muslin/render/scene_view.hpp"

#include <algorithm>
#include <cmath>

namespace muslin {
namespace {

/// Returns metres per unit of texture, from the areas of the triangles in both.
double texture_scale(const Mesh& mesh, const std::vector<Vec3i>& triangles, const std::vector<Vec2>& uvs) {
  double metres = 0;
  double texture = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto at = [&](int i) -> const Vec3& {
      return mesh.positions[static_cast<std::size_t>(triangles[t][i])];
    };
    metres += (at(1) - at(0)).cross(at(2) - at(0)).norm();
    const Vec2 u = uvs[3 * t + 1] - uvs[3 * t];
    const Vec2 v = uvs[3 * t + 2] - uvs[3 * t];
    texture += std::abs(u.x() * v.y() - u.y() * v.x());
  }
  return texture > 0 ? std::sqrt(metres / texture) : 1;
}

/// Returns the texture coordinates of every triangle corner, or none if one is missing.
std::vector<Vec2> corner_textures(const Mesh& mesh, const Triangulation& cut) {
  std::vector<Vec2> uvs;
  if (mesh.corner_uvs.size() != mesh.face_vertices.size() || mesh.corner_uvs.empty()) return uvs;
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    const std::size_t face = static_cast<std::size_t>(cut.faces[t]);
    const std::span<const int> corners = mesh.face(face);
    for (int i = 0; i < 3; ++i) {
      const auto found = std::find(corners.begin(), corners.end(), cut.triangles[t][i]);
      const auto corner = mesh.face_offsets[face] + (found - corners.begin());
      const int uv = found == corners.end() ? -1 : mesh.corner_uvs[static_cast<std::size_t>(corner)];
      if (uv < 0) return {};
      uvs.push_back(mesh.uvs[static_cast<std::size_t>(uv)]);
    }
  }
  return uvs;
}

}  // namespace

Look fabric_look(const Vec3& colour) {
  Look look;
  look.colour = colour;
  look.back_colour = 0.82 * colour + 0.10 * Vec3::Ones();
  look.sheen = 0.35;
  look.translucency = 0.12;
  look.pattern = Pattern::weave;
  return look;
}

Look solid_look(const Vec3& colour) {
  Look look;
  look.colour = colour;
  look.roughness = 0.25;
  look.gloss = 0.5;
  return look;
}

Look prop_look() {
  Look look = solid_look(Vec3(0.52, 0.54, 0.57));
  look.gloss = 0.25;
  return look;
}

Surface make_surface(const Mesh& mesh, const Look& look) {
  const Triangulation cut = triangulate(mesh);
  Surface surface;
  surface.name = mesh.name;
  surface.triangles = cut.triangles;
  surface.rest_positions = mesh.positions;
  surface.look = look;
  if (look.pattern == Pattern::plain || mesh.positions.empty()) return surface;

  Box box;
  for (const Vec3& position : mesh.positions) box.extend(position);
  surface.pattern_positions = corner_textures(mesh, cut);
  if (!surface.pattern_positions.empty()) {
    const double scale = texture_scale(mesh, cut.triangles, surface.pattern_positions);
    for (Vec2& position : surface.pattern_positions) position *= scale;
  } else {
    Eigen::Index thin = 0;
    box.sizes().minCoeff(&thin);
    for (const Vec3i& triangle : cut.triangles)
      for (int i = 0; i < 3; ++i) {
        const Vec3& p = mesh.positions[static_cast<std::size_t>(triangle[i])];
        surface.pattern_positions.emplace_back(p[(thin + 1) % 3], p[(thin + 2) % 3]);
      }
  }
  if (look.pattern_period <= 0) surface.look.pattern_period = box.sizes().maxCoeff() / 120;
  return surface;
}

}  // namespace muslin
