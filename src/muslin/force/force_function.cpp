#include "muslin/force/force_function.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/force/frozen_forces.hpp"

namespace muslin {

ForceFunction::ForceFunction(std::string name, Function function)
    : name_(std::move(name)), function_(std::move(function)) {}

std::unique_ptr<Potential> ForceFunction::potential(const StepContext& step) const {
  std::vector<Vec3> forces(step.positions.size(), Vec3::Zero());
  function_(step.time_begin, step.positions, step.velocities, forces);
  for (std::size_t v = 0; v < forces.size(); ++v) {
    if (forces[v].allFinite()) continue;
    throw Error(
        ErrorKind::usage,
        fmt::format("the force \"{}\" on vertex {} after {:.6g} s is no finite number: ({}, {}, {}) N", name_,
                    v, step.time_begin, forces[v].x(), forces[v].y(), forces[v].z()),
        "return finite forces");
  }
  return std::make_unique<FrozenForces>(std::move(forces));
}

}  // namespace muslin
