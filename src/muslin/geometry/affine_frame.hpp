// AffineFrame holds the four points that move a rigid body: every point of it is a fixed affine combination
// of them.
//
// They are the corners of the equimomental tetrahedron: four equal masses m/4 at
//
//   centre + axes · (±a, ±b, ±c),   even number of minus signs,   a² = S_xx / m, …
//
// in the principal axes of the second moment S have the body's mass, centre and second moment, hence its
// inertia tensor (Routh, Dynamics of a System of Rigid Bodies, art. 36). With x = Σ wᵢ qᵢ the mass matrix of
// q is therefore exactly m/4 · 1, without lumping.
#pragma once

#include <array>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mass_properties.hpp"

namespace muslin {

struct MUSLIN_API AffineFrame {
  Vec3 centre = Vec3::Zero();
  Mat3 axes = Mat3::Identity();  ///< columns; a rotation
  Vec3 radii = Vec3::Ones();     ///< a, b, c > 0 [m]

  std::array<Vec3, 4> corners() const;
  /// Returns the wᵢ, which sum to 1, of a point of the body with the corners at rest.
  std::array<double, 4> weights(const Vec3& point) const;
};

/// Returns the frame of a body of these mass properties (volume > 0). A radius less than a thousandth of the
/// largest is raised to a thousandth, so that the equations stay well conditioned. This slows the spin of a
/// needle about its axis, or of a foil in its plane, which is invisible in pictures.
MUSLIN_API AffineFrame equimomental_frame(const MassProperties& body);

/// Signs of the corners, one row per corner.
inline constexpr std::array<std::array<int, 3>, 4> corner_signs = {
    {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};

}  // namespace muslin
