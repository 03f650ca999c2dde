// Finds the corners of polygons that become the corners of triangles, and their texture coordinates.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Returns the corners of every triangle (#T by 3) as indices into the mesh's face_vertices.
std::vector<Vec3i> triangle_corners(const Mesh& mesh, const Triangulation& cut);

/// A triangle in the texture.
struct TextureTriangle {
  std::array<Vec2, 3> uv;

  double twice_area() const;  ///< signed
  /// False if a height is less than 1e-9 of a side: the triangle has no directions.
  bool has_area() const;
};
/// Returns the triangle of three corners; none if one has no texture coordinates.
std::optional<TextureTriangle> texture_of(const Mesh& mesh, const Vec3i& corners);
/// Returns the polygons with a triangle that has no texture coordinates, or no area in the texture,
/// ascending.
std::vector<int> faces_without_texture(const Mesh& mesh);

}  // namespace muslin
