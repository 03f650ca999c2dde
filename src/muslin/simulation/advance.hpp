// One step of a run: (model, state, length) → (state, report).
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
#include "muslin/solver/solver.hpp"

namespace muslin {

/// A step that cannot be solved is halved so often.
constexpr int max_halvings = 8;

/// Farther from the origin than the distance to the sun is no place for cloth: it was shot there by a force
/// or a speed that nobody meant. Caches hold floats, which end at 3e38 m.
constexpr double farthest = 1.5e11;  // [m]

/// The first vertex whose position is not finite or beyond `farthest`, −1 if there is none.
int vertex_out_of_range(ConstVectors x);

/// Workspaces of the steps of one run. No result depends on them: everything is made anew after `forget`.
/// Whoever puts another value into the state's contact calls `forget` as well.
class Scratch {
 public:
  void forget();
  /// Drops the guard alone.
  void forget_guard();
  /// The guard over state.contact; null if nothing can touch. Errors: those of ContactGuard.
  ContactGuard* guard(const Model& model, RunState& state);
  /// Brings the vectors to the model's size.
  void prepare(const Model& model);
  RunCosts costs() const;  ///< since this was made, whatever was forgotten

  Stepper stepper;
  std::vector<std::uint8_t> fixed;  ///< #V
  std::vector<Vec3> targets;        ///< #V by 3
  std::vector<double> masses;       ///< #V, as the solver wants them: none is 0 [kg]
  ModelParts parts;
  double linearize_seconds = 0, solve_seconds = 0;

 private:
  std::unique_ptr<ContactGuard> guard_;
  RunCosts earlier_;  ///< of guards that are gone
};

/// Advances `state.motion` by `length` [s], with all that goes along with it. A step that cannot be solved is
/// halved; if it was not made in the end, the report says why and `state` is what it was. So it is after an
/// exception, of a load for example. Frames are left to the caller.
StepReport advance(const Model& model, const Terms& terms, RunState& state, double length, Scratch& scratch);

/// By part, the root mean square of the accelerations that fields and loads from outside cause in the step
/// that `context` begins [m/s²]. `loads`: what the loads amount to in it.
std::vector<double> driving_accelerations(const Model& model, const Terms& terms,
                                          std::span<const std::unique_ptr<Potential>> loads,
                                          ConstVectors positions, const Scratch& scratch);

}  // namespace muslin
