// Colliders that move faster than cloth can follow pass through it: to push it they would have to tear it.
#pragma once

#include <vector>

#include "muslin/constraint/prescribed.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// Returns the colliders that are faster than jump_speed (scene/build_contact.hpp) in a step of `length` [s]
/// from `state`.
std::vector<const Prescribed*> jumping_colliders(const Model& model, const State& state, double length);

}  // namespace muslin
