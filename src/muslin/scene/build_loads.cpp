#include "muslin/scene/build_loads.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "muslin/force/gravity.hpp"
#include "muslin/force/point_force.hpp"
#include "muslin/force/wind.hpp"
#include "muslin/scene/pin_sequence.hpp"

namespace muslin {
namespace {

std::vector<int> to_model(const Component& body, std::vector<int> vertices) {
  for (int& v : vertices) v += body.first_vertex;
  return vertices;
}

bool acts_on(const ForceSettings& force, const Component& body) {
  return force.body.empty() || force.body == body.name;
}

void add_gravity(Model& model, const ForceSettings& force) {
  std::vector<double> masses(model.vertex_count(), 0.0);
  for (const Component& body : model.bodies) {
    if (!acts_on(force, body)) continue;
    const auto first = static_cast<std::ptrdiff_t>(body.first_vertex);
    std::copy_n(model.masses.begin() + first, body.vertex_count, masses.begin() + first);
  }
  // Only a field constant during the whole run stores energy; a changing one does work.
  const bool steady =
      force.value.keys.size() == 1 && force.from <= 0 && force.until >= model.scene.time.duration;
  model.loads.push_back(
      {force.name, steady ? EnergyRole::potential : EnergyRole::work,
       std::make_shared<Gravity>(std::move(masses), force.value, Window{force.from, force.until})});
}

void add_point_force(Model& model, const ForceSettings& force) {
  const Component& body = model.body(force.body);
  LoadedVertices loaded = body.loaded_vertices(force.where, "force " + force.name);
  model.loads.push_back(
      {force.name, EnergyRole::work,
       std::make_shared<PointForce>(to_model(body, std::move(loaded.vertices)), force.value,
                                    Window{force.from, force.until}, std::move(loaded.shares))});
}

void add_wind(Model& model, const ForceSettings& force) {
  const auto soft = std::count_if(model.bodies.begin(), model.bodies.end(),
                                  [](const Component& body) { return body.is_soft(); });
  for (const Component& body : model.bodies) {
    if (!acts_on(force, body) || !body.is_soft()) continue;
    Embedding skin = body.skin;
    for (auto& vertices : skin.vertices) {
      for (int& v : vertices) v += body.first_vertex;
    }
    std::vector<Vec3i> triangles = triangulate(body.mesh).triangles;
    if (!body.sheet && body.report.volume < 0) {
      for (Vec3i& triangle : triangles) std::swap(triangle[1], triangle[2]);
    }
    WindSettings wind;
    wind.velocity = force.value;
    wind.window = {force.from, force.until};
    wind.air_density = force.air_density;
    wind.drag = force.drag;
    wind.lift = force.lift;
    wind.gust = force.gust;
    wind.gust_length = force.gust_length;
    wind.seed = static_cast<std::uint64_t>(force.seed);
    // Without a consistent front a face counts from both sides.
    wind.two_sided = body.sheet || body.report.flipped_edges > 0 || body.report.non_manifold_edges > 0;
    const std::string name = soft > 1 ? force.name + ": " + body.name : force.name;
    model.loads.push_back(
        {name, EnergyRole::work,
         std::make_shared<Wind>(wind, std::move(skin), std::move(triangles), model.vertex_count())});
  }
}

Vec3 centre_of(const Model& model, const std::vector<int>& vertices) {
  Vec3 sum = Vec3::Zero();
  for (const int v : vertices) sum += model.rest_positions[static_cast<std::size_t>(v)];
  return sum / static_cast<double>(vertices.size());
}

}  // namespace

void build_forces(Model& model) {
  for (const ForceSettings& force : model.scene.forces) {
    switch (force.type) {
      case ForceSettings::Type::gravity:
        add_gravity(model, force);
        break;
      case ForceSettings::Type::point:
        add_point_force(model, force);
        break;
      case ForceSettings::Type::wind:
        add_wind(model, force);
        break;
    }
  }
}

void build_pins(Model& model) {
  for (const PinSettings& settings : model.scene.pins) {
    const Component& body = model.body(settings.body);
    Pin pin;
    pin.name = settings.name;
    pin.vertices = to_model(body, body.held_vertices(settings.where, "pin " + settings.name));
    pin.from = settings.from;
    pin.until = settings.until;
    pin.motion = settings.motion;
    pin.motion.pivot = settings.pivot.value_or(centre_of(model, pin.vertices));
    if (!settings.sequence.empty()) follow_sequence(model.scene, settings, body, pin);
    model.pins.push_back(std::move(pin));
  }
}

void build_probes(Model& model) {
  for (const ProbeSettings& settings : model.scene.probes) {
    const Component& body = model.body(settings.body);
    Probe probe;
    probe.name = settings.name;
    probe.body = model.bodies.index_of(body);
    AttachedPoint attached = body.attach(settings.at);
    probe.point = std::move(attached.point);
    if (!attached.warning.empty())
      model.warnings.push_back(fmt::format("probe {}: `at` {}", settings.name, attached.warning));
    model.probes.push_back(std::move(probe));
  }
}

}  // namespace muslin
