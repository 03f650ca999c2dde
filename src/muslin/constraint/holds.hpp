// Holds finds the vertices that hard pins hold during a step, and their targets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "muslin/constraint/pin.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// State of the pins between steps, part of the state of a run. It is a value type: a failed step is repeated
/// from a copy made before it. Starts empty.
struct Holds {
  std::vector<std::uint8_t> holding;  ///< #pins, 1 while the pin holds; empty before the first step
  std::vector<Vec3> anchors;          ///< where the vertices were when their pin began, relative to their
                                      ///< points if the pin has a sequence; all pins one after the other [m];
                                      ///< meaningful where the pin is holding

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("holds.holding", self.holding);
    arrays("holds.anchors", self.anchors);
  }

  /// Evaluates the pins for the step from `time_begin`, when the vertices are at `positions`, to `time_end`.
  /// fixed[v] = 1 where v is held at the end of the step, and targets[v] is then its position; elsewhere
  /// fixed[v] = 0 and targets[v] is positions[v].
  ///
  /// A hard pin that is active at `time_end` holds (Pin::acts); one that becomes active records its
  /// vertices from `positions` and discards them when it ends. Where pins overlap, the later one in `pins`
  /// has priority. A pin's first moment is max(from, 0), as runs start at time 0. Soft pins hold nothing.
  void step(std::span<const Pin> pins, double time_begin, double time_end, ConstVectors positions,
            std::span<std::uint8_t> fixed, Vectors targets);

  /// Call when the vertices were set to `positions` from outside at `time`, the end of the last step: active
  /// pins hold the vertices there and move them on from there.
  void reanchor(std::span<const Pin> pins, double time, ConstVectors positions);
};

}  // namespace muslin
