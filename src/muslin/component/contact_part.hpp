// ContactPart is the surface of one component as contact sees it: points as combinations of the component's
// vertices, triangles and planes on them. Vertices and points count from 0 within the component.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/contact/contact_surface.hpp"
#include "muslin/contact/surface_map.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/lattice/embedding.hpp"

namespace muslin {

/// Stiffness of a contact with a deformable body, as a share of the stiffness [N/m] of its material.
inline constexpr double contact_stiffness_share = 0.15;

struct MUSLIN_API ContactPart {
  ContactBody body;                        ///< its frame in vertices of the component
  std::vector<SurfaceMap::Entry> entries;  ///< of all points, by rows
  std::vector<int> offsets = {0};          ///< #points + 1, into entries
  std::vector<Vec3> rest;                  ///< #points, at the start [m]
  std::vector<Vec3i> triangles;            ///< of points
  std::vector<int> faces;                  ///< #triangles, of the mesh; −1 of balls and capsules
  std::vector<ContactPlane> planes;
  ContactPointNumbers varying;  ///< over the points
  /// These bound d̂ if the scene gives none (scene/build_contact.hpp): the mean edge of the surface and the
  /// longest side of the component's bounds [m]. The default values impose no bound.
  double edge = std::numeric_limits<double>::infinity(), size = 0;
  std::string warning;  ///< for the user; empty: none

  /// Adds a point that is the weighted sum of its entries. Returns its number.
  int add_point(std::span<const SurfaceMap::Entry> row, const Vec3& at);
  void add_triangle(const Vec3i& points, int face);
  /// Adds all points of a mesh, carried by `skin`, and its triangles.
  void add_mesh(const Mesh& mesh, const Triangulation& cut, const Embedding& skin);
};

}  // namespace muslin
