#include "muslin/simulation/simulated_body.hpp"

#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/potential/restricted.hpp"
#include "muslin/simulation/simulation.hpp"

namespace muslin {
namespace {

/// A potential that acts in every step, as a load.
class ConstantLoad : public Load {
 public:
  ConstantLoad(std::shared_ptr<const Potential> potential, std::size_t first, std::size_t count)
      : potential_(std::move(potential)), first_(first), count_(count) {}
  std::unique_ptr<Potential> potential(const StepContext& /*step*/) const override {
    return std::make_unique<RestrictedPotential>(potential_, first_, count_);
  }

 private:
  std::shared_ptr<const Potential> potential_;
  std::size_t first_, count_;
};

}  // namespace

ConstVectors SimulatedBody::positions() const {
  return simulation_->model().of(*body_, simulation_->state().positions);
}

ConstVectors SimulatedBody::velocities() const {
  return simulation_->model().of(*body_, simulation_->state().velocities);
}

std::vector<Vec3> SimulatedBody::points() const {
  std::vector<Vec3> points(body_->skin.size());
  body_->skin.apply(positions(), points);
  return points;
}

double SimulatedBody::stretch() const { return body_->max_stretch(positions()); }

void SimulatedBody::add_force(const std::string& name, ForceFunction::Function force) {
  const auto first = static_cast<std::size_t>(body_->first_vertex);
  const auto count = static_cast<std::size_t>(body_->vertex_count);
  auto load = std::make_shared<ForceFunction>(name, std::move(force));
  simulation_->add_load(
      {name, EnergyRole::work, std::make_shared<RestrictedLoad>(std::move(load), first, count)});
}

void SimulatedBody::add_potential(const std::string& name, EnergyRole role,
                                  std::shared_ptr<const Potential> potential) {
  if (!potential)
    throw Error(ErrorKind::usage, "the potential \"" + name + "\" is null", "give one that exists");
  const auto first = static_cast<std::size_t>(body_->first_vertex);
  const auto count = static_cast<std::size_t>(body_->vertex_count);
  simulation_->add_load({name, role, std::make_shared<ConstantLoad>(std::move(potential), first, count)});
}

}  // namespace muslin
