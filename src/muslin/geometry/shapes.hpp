// Makes meshes of spheres, capsules, boxes and planes for pictures and caches. They face outward.
#pragma once

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// A subdivided icosahedron with 642 vertices on the sphere.
Mesh sphere_mesh(const Vec3& centre, double radius);

/// The capsule around the segment a b (a ≠ b): rings of quads, closed by half spheres.
Mesh capsule_mesh(const Vec3& a, const Vec3& b, double radius);

/// An axis-aligned box: eight vertices, six quads.
Mesh box_mesh(const Vec3& centre, const Vec3& size);

/// A square of one quad in the plane through `centre` with this normal, which is also its front side. Its
/// sides are parallel to two axes if the normal is parallel to the third.
Mesh plane_mesh(const Vec3& centre, const Vec3& normal, double side);

}  // namespace muslin
