// Shell is a triangle mesh as thin cloth: triangles with their thread directions, and hinges between them.
//
// Threads run in two directions, warp and weft, at right angles in the cloth at rest. A triangle stores its
// rest shape in these coordinates, so that F = [x₁−x₀, x₂−x₀] `inverse` is the 3 by 2 deformation gradient
// whose columns are the deformed unit vectors of warp and weft.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/shell/rest_shape.hpp"

namespace muslin {

using Mat2 = Eigen::Matrix2d;

/// Two triangles that share the edge of vertices 0 and 1; vertices 2 and 3 are opposite to it.
struct Hinge {  // no padding: models are compared by its bytes
  std::array<int, 4> vertices{};
  double length = 0;      ///< of the edge at rest, the mean of both triangles [m]
  double area = 0;        ///< of both triangles at rest [m²]
  double angle = 0;       ///< between the normals at rest, −π … π; 0 at seams
  double warp_share = 0;  ///< cos² of the angle between warp and the bending direction, across the edge
};

struct Shell {
  std::vector<Vec3i> triangles;      ///< #T, of the mesh's vertices
  std::vector<int> faces;            ///< #T, the polygon each comes from
  std::vector<double> areas;         ///< #T, at rest [m²]
  std::vector<Mat2> inverses;        ///< #T, inverse of the rest edges (columns) in (warp, weft) [1/m]
  std::vector<Hinge> hinges;         ///< of every edge: its first triangle with every other one
  std::vector<double> vertex_areas;  ///< #V, a third of each adjacent triangle at rest [m²]
  double area = 0;                   ///< at rest [m²]
  double mean_edge = 0;              ///< at rest [m]
  std::size_t odd_faces = 0;         ///< triangles perpendicular to the given warp; they got another
  std::size_t seam_hinges = 0;       ///< whose triangles do not share the edge at rest

  std::size_t vertex_count() const { return vertex_areas.size(); }
};

/// Thread directions on the rest shape.
struct Weave {
  /// Warp, projected onto every face. Default: the direction of increasing texture u.
  std::optional<Vec3> warp;
};

/// Edges whose ends lie apart in the rest shape of their two triangles are seams: the triangles are flat
/// there at rest. Errors: input, naming the polygon and the vertices (counted from 1), for triangles given
/// twice or without area, vertices of no polygon, and texture coordinates that are missing or without area
/// where they are needed.
MUSLIN_API Shell build_shell(const Mesh& mesh, const RestShape& rest, const Weave& weave);
/// The vertices of the mesh at `rest_positions` (#V by 3) are the shape without stress. Threads of a mesh
/// without texture coordinates run along the longest side of its box, unless `weave` says otherwise.
MUSLIN_API Shell build_shell(const Mesh& mesh, ConstVectors rest_positions, const Weave& weave);

/// Returns the angle of a hinge: 0 if flat, positive if vertices 2 and 3 turn away from the normal
/// (x₁−x₀)×(x₂−x₀), −π … π.
MUSLIN_API double hinge_angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3);

/// Returns the largest singular value of F of a triangle, given its corners and its matrix of
/// Shell::inverses: its largest stretch in any direction.
double largest_stretch(const Vec3i& corners, const Mat2& inverse, ConstVectors x);
/// Returns the largest stretch of all triangles.
MUSLIN_API double max_stretch(const Shell& shell, ConstVectors x);

}  // namespace muslin
