#include "muslin/scene/build_loads.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "muslin/force/gravity.hpp"
#include "muslin/force/point_force.hpp"
#include "muslin/force/wind.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/scene/build_collider.hpp"
#include "muslin/scene/pin_sequence.hpp"
#include "muslin/scene/select.hpp"

namespace muslin {
namespace {

std::vector<int> to_model(const Body& body, std::vector<int> vertices) {
  for (int& v : vertices) v += body.first_vertex;
  return vertices;
}

bool acts_on(const ForceSettings& force, const Body& body) {
  return force.body.empty() || force.body == body.name;
}

void add_gravity(Model& model, const ForceSettings& force) {
  std::vector<double> masses(model.vertex_count(), 0.0);
  for (const Body& body : model.bodies) {
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

/// Returns the shares of the corners in the forces on points of a rigid body, or in that on its centre.
std::vector<double> shares_of_corners(const Body& body, const ForceSettings& force) {
  if (!force.where) return {0.25, 0.25, 0.25, 0.25};
  std::vector<double> shares(4, 0.0);
  for (const int v : select_vertices(body, *force.where, "force " + force.name))
    for (std::size_t i = 0; i < 4; ++i) shares[i] += body.skin.weights[static_cast<std::size_t>(v)][i];
  return shares;
}

void add_point_force(Model& model, const ForceSettings& force) {
  const Body& body = model.body(force.body);
  std::vector<int> vertices;
  std::vector<double> weights;
  if (body.is_rigid()) {
    vertices = to_model(body, {0, 1, 2, 3});
    weights = shares_of_corners(body, force);
  } else {
    vertices = to_model(body, select_vertices(body, *force.where, "force " + force.name));
  }
  model.loads.push_back(
      {force.name, EnergyRole::work,
       std::make_shared<PointForce>(vertices, force.value, Window{force.from, force.until}, weights)});
}

void add_wind(Model& model, const ForceSettings& force) {
  for (const Body& body : model.bodies) {
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
    const std::string name = model.scene.bodies.size() > 1 ? force.name + ": " + body.name : force.name;
    model.loads.push_back(
        {name, EnergyRole::work,
         std::make_shared<Wind>(wind, std::move(skin), std::move(triangles), model.vertex_count())});
  }
}

/// Returns the point of the surface nearest to `at`, carried by the corners of its triangle.
Embedding point_of_surface(Model& model, const Body& body, const ProbeSettings& settings) {
  const std::vector<Vec3i> triangles = triangulate(body.mesh).triangles;
  const ClosestPoint nearest = ClosestPointQuery(body.mesh.positions, triangles)(settings.at);
  const Vec3i& triangle = triangles[static_cast<std::size_t>(nearest.triangle)];
  Embedding point;
  point.vertices.emplace_back().fill(triangle[0]);
  point.weights.emplace_back().fill(0);
  for (int c = 0; c < 3; ++c) {
    point.vertices[0][static_cast<std::size_t>(c)] = triangle[c];
    point.weights[0][static_cast<std::size_t>(c)] = nearest.barycentric[c];
  }
  if (nearest.distance > body.spacing()) {
    model.warnings.push_back(
        fmt::format("probe {}: `at` lies {:.3g} m from body `{}`; it moves with the nearest "
                    "point",
                    settings.name, nearest.distance, settings.body));
  }
  return point;
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
    const Body& body = model.body(settings.body);
    Pin pin;
    pin.name = settings.name;
    pin.vertices =
        to_model(body, body.is_rigid() ? std::vector<int>{0, 1, 2, 3}
                                       : select_vertices(body, settings.where, "pin " + settings.name));
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
    const Body& body = model.body(settings.body);
    Probe probe;
    probe.name = settings.name;
    probe.body = static_cast<int>(&body - model.bodies.data());
    if (body.is_rigid()) {
      probe.point = embed(body.frame, std::span(&settings.at, 1));
      model.probes.push_back(std::move(probe));
      continue;
    }
    if (!body.has_lattice()) {
      probe.point = point_of_surface(model, body, settings);
      model.probes.push_back(std::move(probe));
      continue;
    }
    probe.point = embed(body.lattice, std::span(&settings.at, 1));
    const auto& weights = probe.point.weights.front();
    if (*std::min_element(weights.begin(), weights.end()) < -0.01) {
      model.warnings.push_back(
          fmt::format("probe {}: `at` lies outside of body `{}`; it moves with the nearest "
                      "voxel",
                      settings.name, settings.body));
    }
    model.probes.push_back(std::move(probe));
  }
}

}  // namespace muslin
