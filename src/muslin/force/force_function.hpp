// ForceFunction applies forces computed by a program: F(t, x, v) as a function.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "muslin/api.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The force F(t, x, v) [N] on every vertex, explicit: read once at the beginning of each step, with the time
/// [s], positions [m] and velocities [m/s] there, and constant during it (W = −F·x). A force that is stiff
/// relative to the step, such as a strong spring or drag, is unstable just as in an explicit integrator: a
/// drag F = −c v needs steps below 2 m/c. A halved step reads it for each half.
class MUSLIN_API ForceFunction : public Load {
 public:
  /// Writes F into `forces`, which is zero; all are #V by 3. Runs in the thread that advances the simulation,
  /// not in several at once. Its exceptions leave Simulation::advance, with the state at the beginning of the
  /// step.
  using Function =
      std::function<void(double time, ConstVectors positions, ConstVectors velocities, Vectors forces)>;

  /// `name` is for messages.
  ForceFunction(std::string name, Function function);
  /// Errors: usage, naming the first vertex with a force that is no finite number.
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  std::string name_;
  Function function_;
};

}  // namespace muslin
