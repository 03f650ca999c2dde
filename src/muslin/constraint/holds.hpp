// Which vertices the pins hold during a step, and where.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "muslin/constraint/pin.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// What pins remember between steps: plain data, part of the state of a run. A value: a step that failed
/// is tried again from a copy made before it. Starts empty.
struct Holds {
  std::vector<std::uint8_t> holding;  ///< #pins, 1 while the pin holds; empty before the first step
  std::vector<Vec3> anchors;          ///< where the vertices were when their pin took hold, seen from their
                                      ///< points if it has a sequence; all pins one after the other [m];
                                      ///< meaningful where the pin is holding

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("holds.holding", self.holding);
    arrays("holds.anchors", self.anchors);
  }

  /// Decides the step from `time_begin`, when the vertices are at `positions`, to `time_end`.
  /// fixed[v] = 1 where v is held at the end of the step, and targets[v] is then its place; elsewhere
  /// fixed[v] = 0 and targets[v] is positions[v].
  ///
  /// A pin that is active at `time_end` holds; one that becomes so takes its vertices from `positions` and
  /// forgets them when it lets go. Where pins overlap, the later in `pins` decides. A pin's first moment is
  /// max(from, 0), as runs start at time 0. `from` and `until` within 1e-6 of a step of `time_end` count
  /// as reached: a clock that adds up steps is not exact.
  void step(std::span<const Pin> pins, double time_begin, double time_end, ConstVectors positions,
            std::span<std::uint8_t> fixed, Vectors targets);

  /// The vertices were put to `positions` by hand at `time`, the end of the last step: pins that are holding
  /// hold them there, and move them on from there.
  void take_anew(std::span<const Pin> pins, double time, ConstVectors positions);
};

}  // namespace muslin
