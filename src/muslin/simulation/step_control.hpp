// The length of steps that the program chooses: frames halved as often as the motion needs.
//
// A step of length dt moves a part by ½ a dt² beyond what its velocity says, a the acceleration of the last
// step (root mean square over its masses). That is kept to a small share of its size, so that the damping of
// the integrator stays small at every resolution alike; what rests takes one step a frame, as far as single
// precision still tells masses from stiffnesses. Two parts that meet go no more than a few edges past each
// other in a step. Where a step took many iterations or missed its tolerance the next ones are shorter, and
// longer again once they are easy.
// docs/theory/solver.md.
#pragma once

#include <cstdint>
#include <span>

#include "muslin/potential/state.hpp"
#include "muslin/simulation/model_parts.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

/// Part of the state of a run: where it is in a frame, and how hard the last steps were.
struct StepControl {
  static constexpr int deepest = 12;                           ///< a frame is halved no more often
  static constexpr std::int64_t frame = std::int64_t{1} << deepest;  ///< in ticks
  std::int64_t ticks = 0;  ///< of the frame in work that are done
  int level = 0;           ///< of the last step: a frame halved so often
  int harder = 0;          ///< levels added because steps were hard

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("steps.ticks", self.ticks);
    arrays("steps.level", self.level);
    arrays("steps.harder", self.harder);
  }

  /// The level that the motion asks for, steps of which fit from here. `accelerations`: by part, of loads.
  int choose(const ModelParts& parts, std::span<const double> accelerations, std::span<const double> masses,
             const State& state, double frame_time, Effort effort) const;
  static std::int64_t length(int level) { return frame >> level; }  ///< in ticks
  /// A step of `chosen` was made.
  void note(int chosen, const StepReport& report);
};

}  // namespace muslin
