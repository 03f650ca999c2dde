// A vector quantity that changes over time, as an animator keys it.
#pragma once

#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Constant, or keyframed: linear between the keys, constant before the first and after the last.
struct Keyed {
  struct Key {
    double time = 0;  ///< [s]
    Vec3 value = Vec3::Zero();
  };
  std::vector<Key> keys;  ///< at least one, times ascend strictly

  Vec3 at(double time) const;
  /// ∫₀ᵗ at(s) ds for t ≥ 0, exactly: how far something carried by a keyed velocity has come.
  Vec3 integral(double time) const;
};

/// The time during which a force acts, and how much of a step that is.
struct Window {
  double from = 0;   ///< [s]
  double until = 0;  ///< [s], may be infinite

  /// The share of the step from `begin` to `end` that lies in the window: 1 inside, 0 outside, between them
  /// in the step that crosses a border. A force scaled by it gives the exact impulse, wherever the steps
  /// fall. Shares within 1e-6 of 0 or 1 are rounding of the clock and are snapped.
  double share(double begin, double end) const;
  /// When to read a keyed value for that step: its end, or the end of the window if that comes first.
  double sample(double end) const;
};

}  // namespace muslin
