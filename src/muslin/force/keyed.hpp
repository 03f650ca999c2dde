// Keyed is a vector that keyframes change over time.
#pragma once

#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/keyed_number.hpp"
#include "muslin/core/keyframes.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// A vector, constant or keyframed: interpolated between the keys, constant before the first and after the
/// last.
struct MUSLIN_API Keyed {
  struct Key {
    double time = 0;  ///< [s]
    Vec3 value = Vec3::Zero();
    Interpolation interpolation = Interpolation::linear;  ///< to the next key
  };
  std::vector<Key> keys;  ///< at least one, times ascend strictly

  Vec3 at(double time) const;
  /// ∫₀ᵗ at(s) ds for t ≥ 0, exactly: the displacement due to a keyed velocity.
  Vec3 integral(double time) const;
};

/// The time during which a force acts, and its share of a step.
struct MUSLIN_API Window {
  double from = 0;   ///< [s]
  double until = 0;  ///< [s], may be infinite

  /// Returns the share of the step from `begin` to `end` that lies in the window: 1 inside, 0 outside,
  /// between them in a step that crosses a border. A force scaled by it gives the exact impulse for any
  /// steps. Shares within 1e-6 of 0 or 1 are due to rounding of the clock and are snapped. A step without
  /// length is inside or outside.
  double share(double begin, double end) const;
  /// Returns the time at which to read a keyed value for that step: its end, or the end of the window if
  /// earlier.
  double sample(double end) const;
};

}  // namespace muslin
