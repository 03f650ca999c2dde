#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "muslin/component/kinds.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/progress_part.hpp"
#include "muslin/potential/restricted.hpp"
#include "muslin/scene/build_contact.hpp"
#include "muslin/scene/build_pins.hpp"
#include "muslin/scene/force_kinds.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/scene/validate.hpp"

namespace muslin {
namespace {

Progress component_progress(const Progress& whole, std::size_t index, std::size_t count) {
  const auto share = [count](std::size_t i) { return static_cast<double>(i) / static_cast<double>(count); };
  return progress_part(whole, share(index), share(index + 1));
}

/// Returns the sources of all components, in the order of Model::bodies.
std::vector<ComponentSource> sources_of(const Scene& scene) {
  std::vector<ComponentSource> sources;
  for (const BodySettings& body : scene.bodies) sources.push_back(source_of(body));
  for (const ColliderSettings& collider : scene.colliders) sources.push_back(source_of(collider));
  sources.insert(sources.end(), scene.components.begin(), scene.components.end());
  return sources;
}

/// Builds components that surround the others last; all keep their places.
std::vector<std::shared_ptr<Component>> build_components(const Scene& scene,
                                                         const std::vector<ComponentSource>& sources,
                                                         std::vector<std::string>& warnings,
                                                         const Progress& progress) {
  const SceneFiles files{scene.file, scene.meshes};
  std::vector<std::shared_ptr<Component>> components(sources.size());
  Box around;
  for (const bool surrounds : {false, true}) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (sources[i].surrounds != surrounds) continue;
      components[i] = sources[i].build({files, scene.time.frame_rate, scene.time.step(), around, warnings,
                                        component_progress(progress, i, sources.size())});
      require(components[i] != nullptr, "the source of a component built none", "return a component");
      if (!surrounds) around.extend(components[i]->mesh.bounds());
    }
  }
  return components;
}

/// Appends the vertices of a component to those of the model.
void add_vertices(Model& model, Component& component, const Place& place) {
  const std::size_t first = model.vertex_count(), count = static_cast<std::size_t>(component.vertex_count);
  if (first + count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(ErrorKind::input, place, "all bodies together have more than 2³¹ vertices",
                "make `voxel_width` larger or meshes coarser");
  }
  component.first_vertex = static_cast<int>(first);
  const std::vector<double> masses = component.masses();
  const std::vector<Vec3> velocities = component.velocities();
  for (std::size_t v = 0; v < count; ++v) {
    model.rest_positions.push_back(component.rest_position(v));
    model.velocities.push_back(velocities[v]);
    model.masses.push_back(masses[v]);
  }
  if (!component.motion()) return;
  model.prescribed.push_back(*component.motion());
  model.prescribed.back().first = component.first_vertex;
}

/// Marks the component's vertices that a pin holds during the whole run. Other pins do not change the
/// energies, so that the stored energy does not jump.
std::vector<std::uint8_t> always_held(const Model& model, const Component& component) {
  const auto count = static_cast<std::size_t>(component.vertex_count);
  std::vector<std::uint8_t> held(count, 0);
  for (const Pin& pin : model.pins) {
    if (pin.is_soft() || pin.from > 0 || std::isfinite(pin.until)) continue;
    for (const int v : pin.vertices) {
      const int local = v - component.first_vertex;
      if (local >= 0 && local < component.vertex_count) held[static_cast<std::size_t>(local)] = 1;
    }
  }
  return held;
}

/// Adds the potentials and loads of a component, as terms of all vertices.
void add_terms(Model& model, const Component& component) {
  const auto first = static_cast<std::size_t>(component.first_vertex),
             count = static_cast<std::size_t>(component.vertex_count);
  const bool alone = count == model.vertex_count();
  for (PotentialTerm term : component.potentials) {
    if (!alone) term.potential = std::make_shared<RestrictedPotential>(term.potential, first, count);
    model.potentials.push_back({component.name + ": " + term.name, term.role, std::move(term.potential)});
  }
  for (LoadTerm term : component.loads) {
    if (!alone) term.load = std::make_shared<RestrictedLoad>(term.load, first, count);
    model.loads.push_back({component.name + ": " + term.name, term.role, std::move(term.load)});
  }
}

/// Chooses the number of steps needed for stability at rest, with a margin.
void choose_explicit_steps(Model& model) {
  TimeSettings& time = model.scene.time;
  if (model.scene.solver.integrator != Integrator::symplectic_euler || time.steps_per_frame) return;
  constexpr double share = 0.9, most = 1e6;  // most: steps of a frame
  double stable = std::numeric_limits<double>::infinity();
  for (const Component& body : model.bodies) stable = std::min(stable, body.statistics.stable_step);
  const double steps = std::ceil(1 / (time.frame_rate * share * stable));
  time.steps_per_frame = static_cast<int>(std::clamp(steps, 1.0, most));
}

void warn_of_explicit_steps(Model& model) {
  if (model.scene.solver.integrator != Integrator::symplectic_euler) return;
  const double step = model.scene.time.step();
  for (const Component& body : model.bodies) {
    if (body.stretch_limit(0)) {
      model.warnings.push_back(
          fmt::format("body {}: `stretch_limit` makes symplectic_euler unstable where it pulls; take an "
                      "implicit integrator",
                      body.name));
    }
    if (step <= body.statistics.stable_step) continue;
    model.warnings.push_back(fmt::format(
        "body {}: symplectic_euler is unstable at steps of {:.3g} s; it needs less than {:.3g} s, "
        "`steps_per_frame` of at least {:.0f}",
        body.name, step, body.statistics.stable_step,
        std::ceil(1 / (model.scene.time.frame_rate * body.statistics.stable_step))));
  }
}

}  // namespace

Model build_model(const Scene& scene, const Progress& progress) {
  validate(scene);
  Model model;
  model.scene = scene;
  model.warnings = scene.warnings;
  const std::vector<ComponentSource> sources = sources_of(scene);
  const std::vector<std::shared_ptr<Component>> components =
      build_components(scene, sources, model.warnings, progress);
  for (std::size_t i = 0; i < components.size(); ++i) {
    add_vertices(model, *components[i], sources[i].place);
    model.bodies.push_back(components[i]);
  }
  build_pins(model);
  for (const std::shared_ptr<Component>& component : components) {
    component->add_terms(always_held(model, *component));
    add_terms(model, *component);
  }
  choose_explicit_steps(model);
  build_forces(model);
  build_pressures(model, components);
  build_attachments(model);
  build_probes(model);
  build_contact(model);
  warn_of_explicit_steps(model);
  warn_of_stiff_pins(model);
  return model;
}

}  // namespace muslin
