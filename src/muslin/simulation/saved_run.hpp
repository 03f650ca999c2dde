// All of a run that changes, as a value: what a checkpoint holds.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "muslin/constraint/holds.hpp"
#include "muslin/constraint/pin.hpp"
#include "muslin/contact/contact_guard.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/simulation/checkpoint.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {

/// What a run has counted so far, beyond its state.
struct Tally {
  double work = 0, dissipated = 0;      ///< since the start [J]
  double unbalanced = 0;                ///< since the start [J]
  std::vector<double> stored;           ///< energy of each potential, then of each load [J]
  std::int64_t newton = 0, linear = 0;  ///< iterations of the frame in work
  double residual = 0;                  ///< largest of the frame in work [m/s²]
  double pressed = 0;                   ///< energy of contact [J]
  double smallest_gap = std::numeric_limits<double>::infinity();  ///< of the frame in work [m]
  int held_back = 0;                                              ///< at the end of the last step
};

/// Identifies a pin across runs: its anchors make sense only for the same vertices, caught at the same time.
struct PinKey {
  std::uint64_t hash = 0;
  std::uint64_t vertices = 0;
  bool operator==(const PinKey&) const = default;
};
std::vector<PinKey> pin_keys(std::span<const Pin> pins);

struct SavedRun {
  CheckpointHeader header;
  State state;
  std::vector<PinKey> pins;  ///< those that `holds` is about
  Holds holds;
  std::vector<std::uint64_t> terms;  ///< hashes of the names of what `tally.stored` is about
  Tally tally;
  ContactMemory contact;
  Diagnostics diagnostics;  ///< of the last finished frame; wall_ms is not kept
};

std::vector<std::uint8_t> to_bytes(const SavedRun& saved);
/// Errors: input, if the bytes are no whole checkpoint, or one of another number of vertices.
SavedRun saved_run(std::span<const std::uint8_t> bytes, std::size_t vertices);

/// What `pins` hold: every pin that was there keeps its anchors; a new one takes hold in its first step.
Holds holds_of(std::span<const Pin> pins, const SavedRun& saved);

}  // namespace muslin
