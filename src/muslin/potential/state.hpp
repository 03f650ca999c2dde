// State is the mechanical state of a run; StepContext is the known data of a step before it is solved.
#pragma once

#include <cstdint>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/history.hpp"

namespace muslin {

/// Positions and velocities of all bodies, shape #V by 3 each. Saved and restored bit for bit.
struct State {
  std::vector<Vec3> positions;            ///< [m]
  std::vector<Vec3> velocities;           ///< [m/s]
  std::vector<Vec3> previous_positions;   ///< one step earlier [m]; empty before the first step
  std::vector<Vec3> previous_velocities;  ///< one step earlier [m/s]; empty before the first step
  double previous_dt = 0;                 ///< length of the step that led here [s], 0 before the first
  double time = 0;                        ///< [s]
  std::int64_t step = 0;
  History history;  ///< of the loads

  template <class Self, class Arrays>
  static void name_arrays(Self& self, Arrays& arrays) {
    arrays("positions", self.positions);
    arrays("velocities", self.velocities);
    arrays("previous_positions", self.previous_positions);
    arrays("previous_velocities", self.previous_velocities);
    arrays("previous_dt", self.previous_dt);
    arrays("time", self.time);
    arrays("step", self.step);
    History::name_arrays(self.history, arrays);
  }
};

/// A step from time_begin to time_end. Integrators differ only in `anchor` and `dt`: velocities at the end
/// of the step are (x − anchor) / dt. For implicit Euler the anchor is the position at the beginning and dt
/// the length of the step; for BDF2 the anchor is a combination of the two last positions and dt two thirds
/// of the step (equal steps). Symplectic Euler reads forces at the beginning of the step; its anchor makes (x
/// − anchor) / dt the velocity at the beginning.
struct StepContext {
  double time_begin = 0;                      ///< [s]
  double time_end = 0;                        ///< [s]
  double dt = 0;                              ///< effective step of the integrator [s]
  double velocity_time = 0;                   ///< when (x − anchor) / dt is the velocity to second order [s]
  double length = 0;                          ///< of the step, time_end − time_begin without its rounding [s]
  std::vector<Vec3> anchor;                   ///< #V by 3 [m]
  std::vector<Vec3> inertial_prediction;      ///< #V by 3, end positions without forces [m]
  std::vector<std::uint8_t> rigidly_rotated;  ///< #V, 1 where anchor and prediction are those of a turning
                                              ///< rigid body; empty: none
  ConstVectors positions;                     ///< #V by 3, at time_begin [m]
  ConstVectors velocities;                    ///< #V by 3, at time_begin [m/s]
  const History* history = nullptr;           ///< of the loads, at time_begin; null: no earlier steps
};

}  // namespace muslin
