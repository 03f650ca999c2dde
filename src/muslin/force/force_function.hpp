// ForceFunction applies forces computed by a program: F(t, x, v) as a function.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "muslin/api.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The force F(t, x, v) [N] on every vertex is explicit: it is evaluated once at the beginning of each step,
/// with the time [s], positions [m] and velocities [m/s] there, and constant during the step (W = −F·x). A
/// force that is stiff relative to the step, such as a strong spring or drag, is unstable just as in an
/// explicit integrator: a drag F = −c v needs steps below 2 m/c. A halved step evaluates it for each half.
class MUSLIN_API ForceFunction : public Load {
 public:
  /// Writes F into `forces`, which is zero on entry; all are #V by 3. Called only in the thread that advances
  /// the simulation. Its exceptions leave Simulation::advance, with the state at the beginning of the step.
  using Function =
      std::function<void(double time, ConstVectors positions, ConstVectors velocities, Vectors forces)>;

  /// `name` is for messages.
  ForceFunction(std::string name, Function function);
  /// Errors: usage, naming the first vertex whose force is not finite.
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  std::string name_;
  Function function_;
};

}  // namespace muslin
