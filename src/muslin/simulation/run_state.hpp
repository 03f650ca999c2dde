// RunState is the complete mutable state of a run, as one value. A step that fails is undone by restoring a
// copy, and a checkpoint stores all of it. Data outside it is scratch.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "muslin/constraint/holds.hpp"
#include "muslin/constraint/pin.hpp"
#include "muslin/contact/contact_memory.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/potential/state_arrays.hpp"
#include "muslin/simulation/checkpoint.hpp"
#include "muslin/simulation/diagnostics.hpp"
#include "muslin/simulation/energy_ledger.hpp"
#include "muslin/simulation/pin_force.hpp"
#include "muslin/simulation/step_control.hpp"

namespace muslin {

/// Identifies a pin across runs: its anchors are valid only for the same vertices and the same start time.
struct PinKey {
  std::uint64_t hash = 0;
  std::uint64_t vertices = 0;
  bool operator==(const PinKey&) const = default;
};
std::vector<PinKey> pin_keys(std::span<const Pin> pins);

template <>
struct ArrayElement<PinKey> {
  static constexpr std::string_view layout = "u64x2";
};

/// New mutable state becomes a member here or of one of these structs, with a line in its name_arrays.
struct RunState {
  State motion;
  int frame = 0;             ///< the last finished frame
  int steps_done = 0;        ///< steps of the current frame
  std::vector<PinKey> pins;  ///< the pins of `holds`
  Holds holds;
  std::vector<PinForce> pin_forces;  ///< #pins; empty before the first step
  ContactMemory contact;  ///< empty if nothing can touch
  EnergyLedger energy;
  StepControl control;
  FrameCounts counts;
  Diagnostics diagnostics;  ///< of the last finished frame

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    State::name_arrays(self.motion, arrays);
    arrays("frame", self.frame);
    arrays("steps_done", self.steps_done);
    arrays("holds.pins", self.pins);
    Holds::name_arrays(self.holds, arrays);
    // Runs without pins do not write it.
    if (!std::is_const_v<Self> || !self.pin_forces.empty()) arrays("holds.forces", self.pin_forces);
    ContactMemory::name_arrays(self.contact, arrays);
    EnergyLedger::name_arrays(self.energy, arrays);
    StepControl::name_arrays(self.control, arrays);
    FrameCounts::name_arrays(self.counts, arrays);
    Diagnostics::name_arrays(self.diagnostics, arrays);
  }
};

std::vector<std::uint8_t> to_checkpoint(const CheckpointHeader& header, const RunState& state);
/// Arrays that the checkpoint lacks keep the values of a new RunState. Errors: input, if the bytes are not a
/// complete checkpoint, contain unknown arrays, or belong to another number of vertices.
RunState from_checkpoint(std::span<const std::uint8_t> bytes, std::size_t vertices);

/// Continues with other pins: pins that were there before keep their anchors; a new pin takes hold in its
/// first step.
void go_on_with(std::span<const Pin> pins, RunState& state);

}  // namespace muslin
