// PinForce is the force that a pin exerts on its body.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "muslin/constraint/pin.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/history.hpp"
#include "muslin/potential/state_arrays.hpp"

namespace muslin {

/// The force in the last step. A hard pin exerts what keeps its vertices where they are, against inertia and
/// all other forces; a soft one the force of its springs and dashpots; a pin that does not act exerts 0.
struct PinForce {
  Vec3 sum = Vec3::Zero();  ///< on all of its vertices [N]
  double mean = 0;          ///< magnitude on a vertex, mean over its vertices [N]
  double largest = 0;       ///< magnitude on a vertex, the largest [N]
  double most = 0;          ///< magnitude of `sum`, the largest of all steps so far [N]
};

template <>
struct ArrayElement<PinForce> {
  static constexpr std::string_view layout = "f64x6";
};

/// Updates the forces after a step from time_begin to time_end. `reactions`: #V, what holds each held vertex
/// [N]. Where hard pins overlap, the vertex belongs to the later one.
void update_pin_forces(std::span<const Pin> pins, double time_begin, double time_end, ConstVectors reactions,
                       const History& history, std::vector<PinForce>& forces);

}  // namespace muslin
