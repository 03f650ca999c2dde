// Finds a common orientation for faces that share edges.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/topology/topology.hpp"

namespace muslin {

/// Faces connected through manifold edges (used by exactly two faces), and those to flip so that they share
/// an orientation.
struct Patches {
  std::vector<int> patch;        ///< #F patch of each face, numbered by their first faces
  std::vector<char> turned;      ///< #F 1 if the face is oriented opposite to the first face of its patch
  std::vector<char> orientable;  ///< #patches 0 for a Möbius strip and the like
};
Patches find_patches(std::span<const EdgeUse> uses, std::size_t face_count);

/// Triangles oriented so that their winding number distinguishes inside from outside.
struct OrientedTriangles {
  std::vector<Vec3i> triangles;  ///< #T as given, up to orientation
  /// True if each edge is traversed equally often in both directions: then the winding number is an integer
  /// off the surface.
  bool watertight = false;
};

/// Each patch gets the orientation of most of its area. The whole surface is flipped if it encloses a
/// negative volume. Components (connected through edges of any kind) that still enclose a negative volume are
/// then flipped, unless they lie inside others (a cavity). Vertices at the same position count as one.
OrientedTriangles orient(ConstVectors positions, std::span<const Vec3i> triangles);

}  // namespace muslin
