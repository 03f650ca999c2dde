// RestShape is the shape without stress of a shell, given for each corner of its polygons.
//
// A sewn garment is one mesh, but its flat pattern is cut along the seams: a vertex on a seam has a place in
// each of the pieces. So corners of one vertex may lie apart at rest. Lengths along a seam may differ on its
// two sides, as every triangle has a shape of its own (docs/theory/shells.md, "Seams").
#pragma once

#include <optional>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

struct RestShape {
  std::vector<Vec3> positions;  ///< [m]
  std::vector<int> corners;     ///< by corner of the mesh's face_vertices: its position
  bool unfolded = false;        ///< a flat pattern: no hinge is bent at rest
  double uv_scale = 0;          ///< of a texture: length of its unit [m]

  /// Returns the axis along the longest side of the box around it.
  Vec3 longest_side() const;
  /// Returns the triangles of corners (#T by 3) as indices into positions.
  std::vector<Vec3i> triangles(std::vector<Vec3i> corners_of_triangles) const;
};

/// Returns the shape with the vertices of the mesh at `positions` (#V).
RestShape rest_of_vertices(const Mesh& mesh, ConstVectors positions);

/// Returns the shape in which texture coordinates (u, v) lie at (`scale` u, `scale` v, 0) [m]. Without
/// `scale` the sums of the areas agree with those of the mesh. Polygons without area in the texture keep the
/// shape of the mesh. Errors: input, if all are such.
RestShape rest_of_texture(const Mesh& mesh, std::optional<double> scale);

}  // namespace muslin
