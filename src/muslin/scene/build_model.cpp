#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "muslin/scene/build_body.hpp"
#include "muslin/scene/build_collider.hpp"
#include "muslin/scene/build_contact.hpp"
#include "muslin/scene/build_loads.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/scene/validate.hpp"

namespace muslin {
namespace {

constexpr double max_steps = 1e6;  // of a frame

Progress body_progress(const Progress& whole, std::size_t index, std::size_t count) {
  Progress part;
  part.cancelled = whole.cancelled;
  if (whole.report) {
    part.report = [&whole, index, count](double fraction, std::string_view stage) {
      whole.report((static_cast<double>(index) + fraction) / static_cast<double>(count), stage);
    };
  }
  return part;
}

/// `masses` and `velocities` are those of the body's vertices.
void add_vertices(Model& model, Body& body, const Place& place, const std::vector<double>& masses,
                  const std::vector<Vec3>& velocities) {
  const std::size_t first = model.vertex_count(), count = static_cast<std::size_t>(body.vertex_count);
  if (first + count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(ErrorKind::input, place, "all bodies together have more than 2³¹ vertices",
                "make `voxel_width` larger or meshes coarser");
  }
  body.first_vertex = static_cast<int>(first);
  for (std::size_t v = 0; v < count; ++v) {
    model.rest_positions.push_back(body.rest_position(v));
    model.velocities.push_back(velocities[v]);
    model.masses.push_back(masses[v]);
    body.statistics.mass += masses[v];
  }
}

void add_collider(Model& model, BuiltCollider built, const ColliderSettings& settings) {
  Body& body = built.body;
  const auto count = static_cast<std::size_t>(body.vertex_count);
  std::vector<double> masses(count, 0.0);
  std::vector<Vec3> velocities(count);
  if (settings.is_free()) {
    masses.assign(count, body.statistics.mass / static_cast<double>(count));
    body.statistics.mass = 0;
    const Vec3 spin = settings.angular_velocity * std::numbers::pi / 180;
    for (std::size_t v = 0; v < count; ++v)
      velocities[v] = settings.velocity + spin.cross(body.rest_position(v) - body.frame.centre);
  } else {
    const double step = model.scene.time.step();
    built.motion.positions(step, velocities);
    for (std::size_t v = 0; v < count; ++v) velocities[v] = (velocities[v] - built.motion.start[v]) / step;
  }
  add_vertices(model, body, settings.place, masses, velocities);
  if (body.prescribed) {
    built.motion.first = body.first_vertex;
    model.prescribed.push_back(std::move(built.motion));
  }
  model.bodies.push_back(std::move(body));
}

/// Builds planes last, as their shown size depends on the others; each at its place among the bodies.
void add_colliders(Model& model) {
  const std::vector<ColliderSettings>& colliders = model.scene.colliders;
  Box around;
  for (const Body& body : model.bodies) around.extend(body.mesh.bounds());
  std::vector<BuiltCollider> built(colliders.size());
  for (const bool planes : {false, true}) {
    for (std::size_t c = 0; c < colliders.size(); ++c) {
      if ((colliders[c].shape == ColliderSettings::Shape::plane) != planes) continue;
      built[c] = build_collider(model.scene, colliders[c], around, model.warnings);
      if (!planes) around.extend(built[c].body.mesh.bounds());
    }
  }
  for (std::size_t c = 0; c < colliders.size(); ++c) add_collider(model, std::move(built[c]), colliders[c]);
}

/// Chooses the number of steps needed for stability at rest, with a margin.
void choose_explicit_steps(Model& model) {
  TimeSettings& time = model.scene.time;
  if (model.scene.solver.integrator != Integrator::symplectic_euler || time.steps_per_frame) return;
  constexpr double share = 0.9;
  double stable = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < model.scene.bodies.size(); ++b)
    stable = std::min(stable, model.bodies[b].statistics.stable_step);
  const double steps = std::ceil(1 / (time.frame_rate * share * stable));
  time.steps_per_frame = static_cast<int>(std::clamp(steps, 1.0, max_steps));
}

void warn_of_explicit_steps(Model& model) {
  if (model.scene.solver.integrator != Integrator::symplectic_euler) return;
  const double step = model.scene.time.step();
  for (std::size_t b = 0; b < model.scene.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (model.scene.bodies[b].stretch_limit) {
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
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Progress part = body_progress(progress, b, scene.bodies.size());
    Body body = build_body(scene, scene.bodies[b], model.warnings, part);
    const std::vector<Vec3> velocities(static_cast<std::size_t>(body.vertex_count), scene.bodies[b].velocity);
    add_vertices(model, body, scene.bodies[b].place, vertex_masses(body, scene.bodies[b]), velocities);
    model.bodies.push_back(std::move(body));
  }
  add_colliders(model);
  build_materials(model);
  choose_explicit_steps(model);
  build_forces(model);
  build_pins(model);
  build_probes(model);
  build_contact(model);
  warn_of_explicit_steps(model);
  return model;
}

}  // namespace muslin
