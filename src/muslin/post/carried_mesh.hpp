// Moves a fine mesh with a coarse surface that has been simulated.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Surfaces which the carried mesh must not cross either.
struct Obstacles {
  std::vector<Vec3> positions;
  std::vector<Vec3i> triangles;
};

/// The points of a carried mesh, and the state of its crossings.
struct Carried {
  std::vector<Vec3> points;
  std::size_t drawn_in = 0;   ///< vertices that lie nearer to the surface than they were modelled
  std::size_t crossings = 0;  ///< pairs of triangles that cross all the same
};

/// Each vertex keeps its distance from the surface along the surface's normal, which is interpolated between
/// the angle-weighted normals of the vertices (Thürmer, Wüthrich 1998), and so moves smoothly from triangle
/// to triangle. A part of the offset that is not along the normal, as beyond a border, turns with the nearest
/// triangle. Rigid motions of the surface move the mesh rigidly.
///
/// In narrow folds, and next to what touches the surface, whole offsets would make the mesh cross itself or
/// an obstacle. Offsets are scaled down there, with a smooth transition around, until each vertex is nearer
/// to its own place on the surface than to any other part of it and to any obstacle, and then until no two
/// triangles cross, by up to ten halvings. Pairs of triangles that cross as modelled may go on crossing.
class CarriedMesh {
 public:
  /// `fine` lies where it is modelled on `coarse`, both at rest. Errors: usage, for a surface without area,
  /// if a vertex of `fine` is further from it than half the surface's size, or
  /// if `fine` is a fiftieth of its size or less.
  CarriedMesh(const Mesh& coarse, const Mesh& fine);
  /// Returns the points for these positions of the coarse surface. Obstacles have the same triangles in
  /// every call.
  Carried points(ConstVectors coarse, const Obstacles& obstacles = {}) const;

 private:
  struct Anchor {
    int triangle = 0;
    Vec3 barycentric = Vec3::Zero();
    double height = 0;              ///< along the interpolated normal [m]
    Vec3 remainder = Vec3::Zero();  ///< of the offset, in the frame of the triangle [m]
    double clearance = 1;           ///< distance from the surface at rest as a share of the offset's length
  };
  std::vector<Vec3> normals(ConstVectors coarse) const;
  std::vector<double> clear_scales(ConstVectors coarse, ConstVectors feet, ConstVectors offsets,
                                   const Obstacles& obstacles) const;
  void smooth(std::vector<double>& scales) const;

  std::vector<Vec3i> coarse_triangles_;              ///< turned the same way where they are joined
  std::vector<Vec3i> triangles_;                     ///< of the fine mesh
  std::vector<int> neighbour_offsets_, neighbours_;  ///< over its edges
  std::vector<Anchor> anchors_;                      ///< of its vertices
  double negligible_ = 0;                            ///< length of an offset that rounding can make [m]
  std::vector<std::pair<int, int>> at_rest_;         ///< pairs of its triangles that cross at rest, ascending
};

}  // namespace muslin
