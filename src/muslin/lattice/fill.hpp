// Computes the share of a voxel filled by a solid, by sampling; for meshes whose volume cannot be computed
// exactly.
#pragma once

#include "muslin/core/vectors.hpp"
#include "muslin/field/signed_distance.hpp"

namespace muslin {

/// Returns the share of 8³ sample points inside the solid, for the cube of this centre and width. Octants
/// farther from the surface than their half diagonal are decided by one sample.
double sampled_fill(const SignedDistance& distance, const Vec3& centre, double width);

}  // namespace muslin
