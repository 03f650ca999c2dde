// stopping_time replaces the step length in quantities that must not depend on it, so that bodies at rest in
// contact do not move when the step changes.
#pragma once

namespace muslin {

/// A time [s] with three uses: contact stops the mass of a rigid body within it; the stiffness of rigid
/// bodies is chosen for steps of this length; the displacement under loads within it sets the error tolerance
/// under contact.
inline constexpr double stopping_time = 1.0 / 240;

}  // namespace muslin
