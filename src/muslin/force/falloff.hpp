// Falloff weakens a field with the distance from its centre, axis or curve.
#pragma once

#include <optional>

#include "muslin/api.hpp"

namespace muslin {

/// The weight at a distance r is
///
///   1 for r ≤ min,   (1 + (r − min) / length)^−power up to max,   0 beyond.
///
/// With length = min it is the power law (r / min)^−power.
struct MUSLIN_API Falloff {
  double power = 0;              ///< ≥ 0; 0: none
  double min = 0;                ///< [m] ≥ 0
  std::optional<double> length;  ///< [m] > 0; default: min, or 1 m if that is 0
  std::optional<double> max;     ///< [m] ≥ min; default: none

  double at(double distance) const;
};

}  // namespace muslin
