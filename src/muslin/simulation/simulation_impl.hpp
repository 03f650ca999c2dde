// Simulation::Impl holds the model, the state and the workspaces of a simulation. For simulation/*.cpp.
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
  std::vector<LoadTerm> loads;  ///< those of the model, then added ones
  RunState state;
  Scratch scratch;
  Untangled untangled;
  double wall_ms = 0;  ///< spent on the current frame

  Impl(std::shared_ptr<const Model> the_model, const SimulationOptions& the_options,
       const Progress& progress);

  TangledStart tangled_start() const {
    return options.allow_tangled ? TangledStart::ignore : model->scene.contact.tangled;
  }

  const TimeSettings& time() const { return model->scene.time; }
  Terms terms() const { return {model->potentials, loads}; }
  void advance();
  double progress() const;  ///< of the current frame, 0 … 1
  /// Refuses, repairs or ignores crossings, as the scene says.
  void begin_contact(const Progress& progress);
  /// Restarts contact, without memory, at positions where only allowed crossings exist. With `leave_free`,
  /// triangles that cross there are not in contact until they part.
  void touch(bool leave_free);
  void measure_energy();
  void describe_state(Diagnostics& row) const;
  /// Replaces positions and velocities as if by hand: the integrator has no previous step.
  void put(State changed);
  /// Copies prescribed vertices from `from` to `to`: they keep their scripted positions.
  void keep_prescribed(ConstVectors from, Vectors to) const;

 private:
  double time_now() const;
  double step_length(int level) const;  ///< [s]
  int choose_level();
  void finish_frame();
  [[noreturn]] void fail(const StepReport& report) const;
};

}  // namespace muslin
