// untangle pulls surfaces apart that cross at the start of a run, before its first frame.
#pragma once

#include "muslin/core/progress.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/advance.hpp"
#include "muslin/simulation/run_state.hpp"
#include "muslin/simulation/untangled.hpp"

namespace muslin {

/// Moves `state` without its time: each step starts at rest, so that the bodies follow their elastic energy,
/// contact and the separations of the tangle (untangle/tangle.hpp) alone; pins and colliders stay where they
/// are at the start. Ends when nothing crosses, or when steps no longer help. Errors: interrupted.
Untangled untangle(const Model& model, const Terms& terms, RunState& state, Scratch& scratch,
                   const Progress& progress);

}  // namespace muslin
