// weld joins the vertices of a mesh that nearly coincide, such as those of panels that look sewn, and
// near_borders finds such vertices where they are not joined.
#pragma once

#include <cstddef>
#include <vector>

#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// A mesh of which vertices were joined or left out, and how it belongs to the original.
struct ReducedMesh {
  Mesh mesh;
  std::vector<int> vertices;  ///< #V of the original: its vertex in `mesh`; −1 if that was left out
  std::vector<int> origins;   ///< #V of `mesh`: the first original vertex
};

/// Joins vertices that lie within `tolerance` ≥ 0 [m] of each other, also through others, and leaves out
/// those of no polygon. A joined vertex has the place of its first. Polygons, texture coordinates and the
/// order of vertices stay; groups contain the joined vertices. Errors: input, if two corners of a polygon
/// would join.
ReducedMesh weld(const Mesh& mesh, double tolerance);
/// Leaves out the vertices of no polygon.
ReducedMesh without_loose_vertices(const Mesh& mesh);

struct NearBorders {
  std::size_t vertices = 0;  ///< on open edges, less than 1 % of the mean edge from another such vertex
  double distance = 0;       ///< the largest of their smallest distances [m]
};
/// Vertices of one edge are not near. Indices must be in range.
NearBorders near_borders(const Mesh& mesh);

}  // namespace muslin
