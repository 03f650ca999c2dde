// Derives the 256 configurations of marching cubes from one rule: on every face of the cube each run of
// inside corners is cut off separately. The rule depends only on the corners of the face, so two cubes cut
// their common face identically and the surface has no cracks. See docs/theory/contour.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace muslin {

/// Points of a cube: 0…11 on its edges, 12…19 its corners. Corner c lies at (c&1, c>>1&1, c>>2&1).
using CubePoint = std::int8_t;

/// Edge 4·axis + n runs along the axis from the n-th corner that has 0 there.
struct CubeEdge {
  int low = 0, high = 0;  ///< corners
  int axis = 0;
};
CubeEdge cube_edge(int edge);
/// Returns the edge between two neighbouring corners.
int edge_between(int corner, int other);

/// Returns the corners of face 2·axis + side, counterclockwise seen from outside.
std::array<int, 4> face_corners(int face);

/// Returns the inside part of a polygon: each run of inside corners with the crossings before and after it,
/// in the order of the polygon. Positions in the result: 2·i is corner i, 2·i + 1 the crossing between i and
/// i + 1.
std::vector<std::vector<int>> inside_runs(int inside_of_four);

struct CubeCase {
  std::vector<std::array<CubePoint, 3>> surface;              ///< between inside and outside
  std::array<std::vector<std::array<CubePoint, 3>>, 6> caps;  ///< the inside part of each face
};
/// Bit c of the index is set if corner c is inside. Triangles are counterclockwise seen from outside of the
/// solid.
const std::array<CubeCase, 256>& marching_cubes_table();

}  // namespace muslin
