// The time that stands in for the step where something must not depend on the step: what rests under contact
// stays where it is when steps become longer or shorter.
#pragma once

namespace muslin {

/// Contact stops the mass of a rigid body within it, rigid bodies are as stiff as steps of it ask for, and
/// under contact a step may be wrong by a share of what loads move a body by in it [s].
inline constexpr double stopping_time = 1.0 / 240;

}  // namespace muslin
