// Computes volume, centre and second moments of solids of uniform density: exact, by closed forms and by
// integrals over the faces of a polyhedron (Mirtich, Fast and Accurate Computation of Polyhedral Mass
// Properties, 1996).
#pragma once

#include <span>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// Mass properties of a solid of density 1. The inertia tensor about the centre is tr(S)·1 − S.
struct MassProperties {
  double volume = 0;                  ///< [m³]
  Vec3 centre = Vec3::Zero();         ///< [m]
  Mat3 second_moment = Mat3::Zero();  ///< S = ∫ (x − centre)(x − centre)ᵀ dV [m⁵]
};

MUSLIN_API MassProperties sphere_mass(const Vec3& centre, double radius);
/// For the capsule around the segment a b.
MUSLIN_API MassProperties capsule_mass(const Vec3& a, const Vec3& b, double radius);
/// For an axis-aligned box.
MUSLIN_API MassProperties box_mass(const Vec3& centre, const Vec3& size);
/// For the solid enclosed by the triangles (#T by 3, indices into positions), which must be closed and face
/// outward. Inward faces flip the signs of volume and second moment.
MUSLIN_API MassProperties polyhedron_mass(ConstVectors positions, std::span<const Vec3i> triangles);

}  // namespace muslin
