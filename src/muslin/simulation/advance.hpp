// advance makes one step of a run: (model, state, length) → (state, report).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/contact/contact_guard.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/simulation/diagnostics.hpp"
#include "muslin/simulation/model_parts.hpp"
#include "muslin/simulation/run_state.hpp"
#include "muslin/simulation/yielding.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

/// A step that cannot be solved is halved at most this many times.
constexpr int max_halvings = 8;

/// Coordinates beyond the distance to the sun are taken for an error in a force or speed. Caches store
/// floats, whose largest value is 3e38.
constexpr double farthest = 1.5e11;  // [m]

/// Returns the first vertex whose position is not finite or beyond `farthest`, −1 if there is none.
int vertex_out_of_range(ConstVectors x);

/// Workspaces of the steps of one run. No result depends on them: everything is rebuilt after `forget`. Code
/// that changes the state's contact must also call `forget`.
class Scratch {
 public:
  void forget();
  /// Drops only the guard.
  void forget_guard();
  /// Returns the guard of state.contact; null if nothing can touch. Errors: as the constructor of
  /// ContactGuard.
  ContactGuard* guard(const Model& model, RunState& state);
  /// Resizes the vectors to the model.
  void prepare(const Model& model);
  RunCosts costs() const;  ///< since construction, forgotten workspaces included

  Stepper stepper;
  std::vector<std::uint8_t> fixed;  ///< #V
  std::vector<Vec3> targets;        ///< #V by 3
  std::vector<double> masses;       ///< #V, for the solver: none is 0 [kg]
  ModelParts parts;
  Yielding yielding;
  double linearize_seconds = 0, solve_seconds = 0;

 private:
  std::unique_ptr<ContactGuard> guard_;
  RunCosts earlier_;  ///< of earlier guards
};

/// Advances `state.motion` by `length` [s], and with it holds, contact, energy and counts. A step that cannot
/// be solved is halved. If that fails too, the report states the failure and `state` is unchanged; it is also
/// unchanged after an exception, for example from a load. The caller handles frames.
StepReport advance(const Model& model, const Terms& terms, RunState& state, double length, Scratch& scratch);

/// Returns, by part, the root mean square of the accelerations that fields and external loads cause in the
/// step of `context` [m/s²]. `loads`: the potentials of the loads in this step.
std::vector<double> driving_accelerations(const Model& model, const Terms& terms,
                                          std::span<const std::unique_ptr<Potential>> loads,
                                          ConstVectors positions, const Scratch& scratch);

}  // namespace muslin
