// Computes the placement of a body in the world.
#pragma once

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Returns the rotation by Euler angles in degrees: about x first, then about y, then about z, all axes
/// fixed.
Eigen::Quaterniond rotation_from_degrees(const Vec3& degrees);

/// Returns x ↦ R·(scale ∘ x) + translate.
Eigen::Affine3d placement(const Vec3& translate, const Vec3& rotate_degrees, const Vec3& scale);

}  // namespace muslin
