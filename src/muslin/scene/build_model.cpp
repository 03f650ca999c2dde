#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "muslin/scene/build_body.hpp"
#include "muslin/scene/build_loads.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {
namespace {

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

void add_vertices(Model& model, Body& body, const BodySettings& settings) {
  const std::size_t first = model.vertex_count(), count = static_cast<std::size_t>(body.vertex_count);
  if (first + count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(ErrorKind::input, settings.place, "all bodies together have more than 2³¹ vertices",
                "make `voxel_width` larger or meshes coarser");
  }
  body.first_vertex = static_cast<int>(first);
  const std::vector<double> masses = vertex_masses(body, settings);
  for (std::size_t v = 0; v < count; ++v) {
    model.rest_positions.push_back(body.rest_position(v));
    model.masses.push_back(masses[v]);
    body.statistics.mass += masses[v];
  }
}

void warn_of_explicit_steps(Model& model) {
  if (model.scene.solver.integrator != Integrator::symplectic_euler) return;
  const double step = model.scene.time.step();
  for (const Body& body : model.bodies) {
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
  Model model;
  model.scene = scene;
  model.warnings = scene.warnings;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Progress part = body_progress(progress, b, scene.bodies.size());
    Body body = build_body(scene, scene.bodies[b], model.warnings, part);
    add_vertices(model, body, scene.bodies[b]);
    model.bodies.push_back(std::move(body));
  }
  build_materials(model);
  build_forces(model);
  build_pins(model);
  build_probes(model);
  warn_of_explicit_steps(model);
  return model;
}

}  // namespace muslin
