#include "muslin/scene/build_pins.hpp"

#include <utility>

#include <fmt/format.h>

#include "muslin/scene/pin_sequence.hpp"

namespace muslin {
namespace {

std::vector<int> to_model(const Component& body, std::vector<int> vertices) {
  for (int& v : vertices) v += body.first_vertex;
  return vertices;
}

Vec3 centre_of(const Model& model, const std::vector<int>& vertices) {
  Vec3 sum = Vec3::Zero();
  for (const int v : vertices) sum += model.rest_positions[static_cast<std::size_t>(v)];
  return sum / static_cast<double>(vertices.size());
}

}  // namespace

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
