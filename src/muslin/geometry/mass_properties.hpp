// Volume, centre and second moments of solids of even density: exact, by closed forms and by integrals over
// the faces of a polyhedron (Mirtich, Fast and Accurate Computation of Polyhedral Mass Properties, 1996).
#pragma once

#include <span>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Of a solid of density 1. The inertia tensor about the centre is tr(S)·1 − S.
struct MassProperties {
  double volume = 0;                  ///< [m³]
  Vec3 centre = Vec3::Zero();         ///< [m]
  Mat3 second_moment = Mat3::Zero();  ///< S = ∫ (x − centre)(x − centre)ᵀ dV [m⁵]
};

MassProperties sphere_mass(const Vec3& centre, double radius);
/// Around the segment a b.
MassProperties capsule_mass(const Vec3& a, const Vec3& b, double radius);
/// Along the axes.
MassProperties box_mass(const Vec3& centre, const Vec3& size);
/// What the triangles (#T by 3, indices into positions) enclose; they must be closed and face outward.
/// Facing inward turns the signs of volume and second moment.
MassProperties polyhedron_mass(ConstVectors positions, std::span<const Vec3i> triangles);

}  // namespace muslin
