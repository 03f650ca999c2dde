// Turns Euler angles into rotations.
#pragma once

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Returns the rotation by angles in degrees: about x first, then about y, then about z, all axes fixed. It
/// is exact for multiples of a quarter turn, so that a body turned upright keeps its round coordinates.
Mat3 turned_by_degrees(const Vec3& degrees);

}  // namespace muslin
