// inspect reports defects and the kind of a mesh before anything is built from it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

struct MeshReport {
  std::size_t vertices = 0, faces = 0, triangles = 0, components = 0;
  std::size_t open_edges = 0;          ///< used by one face
  std::size_t non_manifold_edges = 0;  ///< used by three or more
  std::size_t flipped_edges = 0;       ///< used twice in the same direction
  std::size_t degenerate_faces = 0;    ///< zero area
  std::size_t duplicate_faces = 0, unused_vertices = 0;
  std::size_t near_border_vertices = 0;  ///< nearly at another one of a border, without being joined
  double near_border_distance = 0;       ///< at most so far from it [m]
  double area = 0;    ///< [m²]
  double volume = 0;  ///< enclosed, signed [m³]; meaningful if closed
  Box bounds;
  bool closed = false;
  int flat_axis =
      -1;  ///< 0, 1, 2 if the faces lie in a plane x, y or z = const (to 1e-9 of the size), else −1
  std::vector<std::string> warnings;  ///< sentences for the user, each with a remedy
};
/// Works for any mesh; if an index or a position is invalid, only the counts of vertices and faces and that
/// warning are filled in. Components are joined by shared vertices.
MUSLIN_API MeshReport inspect(const Mesh& mesh);
/// As inspect, for thin cloth: edges of three and more faces are seams and give no warning.
MUSLIN_API MeshReport inspect_cloth(const Mesh& mesh);

/// Larger meshes [m] get a warning about units.
inline constexpr double largest_mesh = 200;
/// Coordinates beyond this [m] are refused, since the file must be broken.
inline constexpr double largest_coordinate = 1e9;

/// Throws Error(input) naming `file` if the mesh cannot be used at all: no vertices, no faces, a position
/// that is not finite or beyond 1e9 m, an index out of range, no area.
MUSLIN_API void require_usable(const Mesh& mesh, const std::string& file);

}  // namespace muslin
