// Finds faces that share an edge and a common orientation for them.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// One side of one face.
struct EdgeUse {
  int low = 0, high = 0;  ///< the edge's vertices, low ≤ high
  int face = 0;
  int corner = 0;        ///< index of the corner where the side starts
  bool ascends = false;  ///< the face runs from low to high
};

/// Returns the sides of all faces, sorted by edge, then face, then corner. Faces as in Mesh: face f has
/// corners face_offsets[f] … face_offsets[f+1]−1, corner c is vertex face_vertices[c]. Sides from a vertex to
/// itself are left out.
std::vector<EdgeUse> edge_uses(std::span<const int> face_offsets, std::span<const int> face_vertices);

/// Calls visit(uses of one edge) for each edge of sorted `uses`.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].low == uses[begin].low && uses[end].high == uses[begin].high) ++end;
    visit(uses.subspan(begin, end - begin));
  }
}

/// Faces connected through manifold edges (used by exactly two faces), and those to flip so that they share
/// an orientation.
struct Patches {
  std::vector<int> patch;        ///< #F patch of each face, numbered by their first faces
  std::vector<char> turned;      ///< #F 1 if the face runs against the first face of its patch
  std::vector<char> orientable;  ///< #patches 0 for a Möbius strip and the like
};
Patches find_patches(std::span<const EdgeUse> uses, std::size_t face_count);

/// Triangles oriented so that their winding number distinguishes inside from outside.
struct OrientedTriangles {
  std::vector<Vec3i> triangles;  ///< #T as given, up to orientation
  /// Each edge is traversed equally often in both directions: the winding number is an integer off the
  /// surface.
  bool watertight = false;
};

/// Each patch gets the orientation of most of its area. Then the whole is flipped if it encloses a negative
/// volume, as are single components (connected through edges of any kind) that still do, unless they lie
/// inside others (a cavity). Vertices at the same position count as one.
OrientedTriangles orient(ConstVectors positions, std::span<const Vec3i> triangles);

}  // namespace muslin
