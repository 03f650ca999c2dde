// Checks that the momentum of a run is that which gravity gave it.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "muslin/cache/run_reader.hpp"

namespace muslin {

/// Pins, fixed colliders, wind and point forces push on bodies, and their impulses are not recorded. Without
/// them the momentum at time t is p(0) + m g t: springs, threads, contact between bodies and friction are
/// internal.
struct MomentumCheck {
  std::string why_not;   ///< in words, where it cannot be checked; empty otherwise
  double deviation = 0;  ///< the largest |p − p(0) − m g t| [kg·m/s]
  /// The largest of |p − p(0)|, |p(0)|, |m g t|, the momentum √(2 m E) of all kinetic energy if it went one
  /// way, and that of a speed of 1 µm/s [kg·m/s].
  double scale = 0;
  int frame = 0;  ///< of the largest deviation

  double share() const { return deviation > 0 ? deviation / scale : 0; }
};

/// `scene`: resolved; `statistics`: stats.json.
MomentumCheck check_momentum(const RunReader& run, const nlohmann::ordered_json& scene,
                             const nlohmann::ordered_json& statistics);

}  // namespace muslin
