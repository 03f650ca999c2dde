// Makes meshes of spheres, capsules, boxes and planes for pictures and caches. They face outward.
#pragma once

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Triangles of a subdivided icosahedron, vertices on the sphere: 642 of them.
Mesh sphere_mesh(const Vec3& centre, double radius);

/// Around the segment a b: rings of quads, closed by half spheres. a ≠ b.
Mesh capsule_mesh(const Vec3& a, const Vec3& b, double radius);

/// Eight vertices, six quads, along the axes.
Mesh box_mesh(const Vec3& centre, const Vec3& size);

/// A square of one quad in the plane through `centre` across `normal`, seen from where the normal points to;
/// its sides run along two axes if the normal does.
Mesh plane_mesh(const Vec3& centre, const Vec3& normal, double side);

}  // namespace muslin
