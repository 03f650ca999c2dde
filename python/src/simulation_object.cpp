#include "simulation_object.hpp"

#include <algorithm>

#include "errors.hpp"
#include <fmt/format.h>

namespace muslin::python {

SimulationObject::Work::Work(SimulationObject& object) : object_(object) {
  if (object.worker_ == std::this_thread::get_id()) {
    throw Error(ErrorKind::usage, "the simulation is at work on a step, and calls back",
                "a callback may read the simulation; change it between steps");
  }
  object.simulation();
  object.worker_ = std::this_thread::get_id();
}

const Simulation& SimulationObject::simulation() const {
  if (worker_ != std::thread::id() && worker_ != std::this_thread::get_id()) {
    throw Error(ErrorKind::usage, "another thread is advancing this simulation",
                "wait until it is done, or make a simulation for each thread");
  }
  return simulation_;
}

void SimulationObject::changed() {
  positions_.reset();
  velocities_.reset();
}

void SimulationObject::advance(const Progress& progress) {
  Work work(*this);
  changed();
  {
    const nb::gil_scoped_release nogil;
    simulation_.advance(progress);
  }
  history_.push_back(simulation_.diagnostics());
}

void SimulationObject::step() {
  Work work(*this);
  changed();
  const int frame = simulation_.frame();
  {
    const nb::gil_scoped_release nogil;
    simulation_.step();
  }
  if (simulation_.frame() != frame) history_.push_back(simulation_.diagnostics());
}

void SimulationObject::restore(const std::vector<std::uint8_t>& bytes) {
  Work work(*this);
  simulation_.restore(bytes);
  restored();
}

void SimulationObject::restored() {
  changed();
  history_ = {simulation_.diagnostics()};
}

void SimulationObject::set_positions(nb::handle positions) {
  Work work(*this);
  simulation_.set_positions(as_vectors(positions, "positions", model_->vertex_count()));
  changed();
  if (simulation_.steps_done() == 0) history_.back() = simulation_.diagnostics();
}

void SimulationObject::set_velocities(nb::handle velocities) {
  Work work(*this);
  simulation_.set_velocities(as_vectors(velocities, "velocities", model_->vertex_count()));
  changed();
  if (simulation_.steps_done() == 0) history_.back() = simulation_.diagnostics();
}

void SimulationObject::cut(const std::string& body, const std::vector<std::array<int, 2>>& edges) {
  Work work(*this);
  simulation_.cut(body, edges);
  model_ = simulation_.shared_model();
  cut_ = true;
  forces_.clear();
  changed();
  if (simulation_.steps_done() == 0) history_.back() = simulation_.diagnostics();
}

void SimulationObject::add_force(nb::object function, const std::string& name,
                                 const std::optional<std::string>& body) {
  Work work(*this);
  std::size_t first = 0, count = model_->vertex_count();
  if (body) {
    const Component& acted_on = find_body(*model_, body);
    first = static_cast<std::size_t>(acted_on.first_vertex);
    count = static_cast<std::size_t>(acted_on.vertex_count);
  }
  const std::size_t index = forces_.size();
  const std::string what = "what the force \"" + name + "\" returned";
  auto load = std::make_shared<ForceFunction>(
      name, [this, index, what, first, count](double time, ConstVectors x, ConstVectors v, Vectors f) {
        call_force(index, what, time, x.subspan(first, count), v.subspan(first, count),
                   f.subspan(first, count));
      });
  simulation_.add_load({name, EnergyRole::work, std::move(load)});
  forces_.push_back(std::move(function));
}

void SimulationObject::call_force(std::size_t index, const std::string& what, double time, ConstVectors x,
                                  ConstVectors v, Vectors f) const {
  const nb::gil_scoped_acquire gil;
  if (index >= forces_.size()) return;  // the interpreter is taking everything down
  const nb::object function = forces_[index];
  // Copies, because the callable may keep them.
  const auto array = [](ConstVectors vectors) {
    return taken(std::vector<Vec3>(vectors.begin(), vectors.end()));
  };
  const nb::object forces = function(array(x), array(v), time);
  if (forces.is_none()) return;
  const std::vector<Vec3> given = as_vectors(forces, what, f.size());
  std::copy(given.begin(), given.end(), f.begin());
}

nb::object SimulationObject::snapshot(nb::object& kept, const std::vector<Vec3>& vectors) const {
  const auto array = [&] {
    const auto [copy, owner] = given_away(std::vector<Vec3>(vectors));
    return nb::cast(view(*copy, owner));
  };
  simulation();
  if (worker_ != std::thread::id()) return array();  // in a callback: the state goes on changing
  if (!kept.is_valid()) kept = array();
  return kept;
}

nb::object SimulationObject::positions() { return snapshot(positions_, simulation().state().positions); }
nb::object SimulationObject::velocities() { return snapshot(velocities_, simulation().state().velocities); }

void SimulationObject::forget_forces() { forces_.clear(); }

const Component& find_body(const Model& model, const std::optional<std::string>& name) {
  std::vector<std::string> names;
  const Component* only = nullptr;
  int soft = 0;
  for (const Component& body : model.bodies) {
    names.push_back(body.name);
    if (!body.is_soft()) continue;
    ++soft;
    only = &body;
  }
  if (name) return model.bodies[choice(*name, names, "body of the model")];
  if (soft != 1)
    throw Error(ErrorKind::usage, "the model has several bodies", "name one of " + name_list(names));
  return *only;
}

}  // namespace muslin::python
