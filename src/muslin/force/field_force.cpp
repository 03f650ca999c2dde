#include "muslin/force/field_force.hpp"

#include <utility>

#include "muslin/core/parallel.hpp"
#include "muslin/force/frozen_forces.hpp"

namespace muslin {
namespace {

constexpr std::size_t field_grain = 256;

}  // namespace

FieldForce::FieldForce(std::vector<double> masses, Field acceleration)
    : masses_(std::move(masses)), acceleration_(std::move(acceleration)) {}

std::unique_ptr<Potential> FieldForce::potential(const StepContext& step) const {
  const double strength = acceleration_.extent.strength_in(step.time_begin, step.time_end);
  if (strength == 0) return nullptr;
  const double time = acceleration_.extent.sampled(step.time_end);
  std::vector<Vec3> forces(step.positions.size(), Vec3::Zero());
  parallel_for(forces.size(), field_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (masses_[v] > 0) forces[v] = masses_[v] * strength * acceleration_.at(step.positions[v], time);
  });
  return std::make_unique<FrozenForces>(std::move(forces));
}

}  // namespace muslin
