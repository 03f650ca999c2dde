// stopping_time replaces the step where a quantity must not depend on it: bodies at rest in contact do not
// move when the step changes.
#pragma once

namespace muslin {

/// Time in which contact stops the mass of a rigid body, step for which rigid bodies are stiff enough, and
/// time whose displacement under loads sets the error tolerance under contact [s].
inline constexpr double stopping_time = 1.0 / 240;

}  // namespace muslin
