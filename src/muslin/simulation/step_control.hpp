// StepControl chooses the length of adaptive steps: a frame is halved as often as the motion requires.
//
// A step of length dt moves a part by ½ a dt² beyond a straight motion, with a the acceleration of the last
// step (root mean square over its masses). This displacement is limited to a small share of the part's size,
// so that the damping of the integrator is equally small at every resolution. A body at rest takes one step
// per frame, as long as single precision resolves masses against stiffnesses. Two parts that meet slide past
// each other by at most a few edges in a step. If a step took many iterations or missed its tolerance, the
// next steps are shorter, and longer again once they converge easily. docs/theory/solver.md.
#pragma once

#include <cstdint>
#include <span>

#include "muslin/potential/state.hpp"
#include "muslin/simulation/model_parts.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

/// Part of the state of a run: the position within a frame, and how hard the last steps were.
struct StepControl {
  static constexpr int deepest = 12;                                 ///< a frame is halved at most this often
  static constexpr std::int64_t frame = std::int64_t{1} << deepest;  ///< in ticks
  std::int64_t ticks = 0;                                            ///< done, of the current frame
  int level = 0;   ///< of the last step: how often the frame is halved
  int harder = 0;  ///< levels added because steps were hard

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("steps.ticks", self.ticks);
    arrays("steps.level", self.level);
    arrays("steps.harder", self.harder);
  }

  /// Returns the level that the motion requires, such that its steps fit into the rest of the frame.
  /// `accelerations`: by part, of loads [m/s²].
  int choose(const ModelParts& parts, std::span<const double> accelerations, std::span<const double> masses,
             const State& state, double frame_time, Effort effort) const;
  static std::int64_t length(int level) { return frame >> level; }  ///< in ticks
  /// Records a step of level `chosen`.
  void note(int chosen, const StepReport& report);
};

}  // namespace muslin
