// The inside of a Simulation: a model, a state, and what drives the one with the other. For simulation/*.cpp.
#pragma once

#include <memory>
#include <vector>

#include "muslin/scene/model.hpp"
#include "muslin/simulation/advance.hpp"
#include "muslin/simulation/run_state.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {

struct Simulation::Impl {
  std::shared_ptr<const Model> model;
  SimulationOptions options;
  std::vector<LoadTerm> loads;  ///< those of the model, then those that were added
  RunState state;
  Scratch scratch;
  double wall_ms = 0;  ///< spent on the frame in work

  Impl(std::shared_ptr<const Model> the_model, const SimulationOptions& the_options);

  const TimeSettings& time() const { return model->scene.time; }
  Terms terms() const { return {model->potentials, loads}; }
  void advance();
  double progress() const;  ///< of the frame in work, 0 … 1
  /// Throws what is wrong with positions at which contact is to begin.
  void require_untangled(const std::vector<Vec3>& positions) const;
  /// Begins contact without a past, at positions where nothing crosses that may not. With `leave_free` what
  /// crosses there is left free until it parts.
  void touch(bool leave_free);
  void measure_energy();
  void describe_state(Diagnostics& row) const;
  /// By hand; for what was put there is no step before.
  void put(State changed);
  /// Vertices that move as they are told do not move otherwise.
  void keep_prescribed(ConstVectors from, Vectors to) const;

 private:
  double time_now() const;
  double step_length(int level) const;  ///< [s]
  int choose_level();
  void finish_frame();
  [[noreturn]] void fail(const StepReport& report) const;
};

}  // namespace muslin
