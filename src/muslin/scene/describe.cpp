#include "muslin/scene/describe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/contact/contact_model.hpp"
#include "muslin/core/counted.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/untangle/tangle.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t max_crossings = 8;  // in a text

Json vector(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }
Json finite(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

/// Returns the step below which symplectic_euler is stable for every body [s].
double stable_step(const Model& model) {
  double step = std::numeric_limits<double>::infinity();
  for (const Component& body : model.bodies) step = std::min(step, body.statistics.stable_step);
  return step;
}

struct MapRange {
  double least = std::numeric_limits<double>::infinity(), most = -least, mean = 0;
};
MapRange range_of(const MappedNumber& map) {
  MapRange range;
  for (std::size_t v = 0; v < map.weights.size(); ++v) {
    const double number = map.at(v);
    range.least = std::min(range.least, number);
    range.most = std::max(range.most, number);
    range.mean += number / static_cast<double>(map.weights.size());
  }
  return range;
}

Json maps_json(const Component& body) {
  Json list = Json::array();
  for (const MappedNumber& map : body.maps) {
    const auto [least, most, mean] = range_of(map);
    list.push_back({{"key", map.variation.key},
                    {"map", map.variation.map},
                    {"unit", map.unit},
                    {"min", least},
                    {"max", most},
                    {"mean", mean}});
  }
  return list;
}

std::string maps_text(const Component& body) {
  std::string text;
  for (const MappedNumber& map : body.maps) {
    const auto [least, most, mean] = range_of(map);
    text += fmt::format("  map         {} {:.4g} to {:.4g}{}{}, mean {:.4g}, by `{}`\n", map.variation.key,
                        least, most, map.unit.empty() ? "" : " ", map.unit, mean, map.variation.map);
  }
  return text;
}

/// Returns the descriptions of all components that are colliders, or of all others.
Json list_of(const Model& model, bool colliders) {
  Json list = Json::array();
  for (const Component& body : model.bodies) {
    if (body.is_collider() != colliders) continue;
    list.push_back(Json::parse(body.description_json()));
    if (!body.maps.empty()) list.back()["maps"] = maps_json(body);
  }
  return list;
}

/// Returns null if nothing can touch.
Json contact_json(const Model& model) {
  if (!model.contact) return nullptr;
  const ContactModel& contact = *model.contact;
  const ContactSurface& surface = *contact.surface;
  Json json = {{"distance", surface.ranges(contact.distance)[1]},
               {"friction", contact.friction.keys.front().value},
               {"triangles", surface.triangles().size()}};
  for (std::size_t b = 0; b < surface.bodies().size(); ++b)
    if (const ContactBody& body = surface.bodies()[b]; !body.fixed)
      json["distances"].push_back(
          {{"body", contact.names[b]}, {"distance", body.range.value_or(contact.distance)}});
  json["rules"] = surface.rules().all().size();
  return json;
}

std::string contact_text(const ContactModel& contact) {
  const auto [least, most] = contact.surface->ranges(contact.distance);
  std::string text = least < most ? fmt::format("contact: within {:.3g} to {:.3g} m", least, most)
                                  : fmt::format("contact: within {:.3g} m", most);
  text += fmt::format(", friction {:.3g}{}", contact.friction.keys.front().value,
                      contact.friction.is_constant() ? "" : " at first");
  const std::size_t rules = contact.surface->rules().all().size();
  return text + (rules > 0 ? fmt::format(", {} for pairs\n", counted(rules, "rule")) : "\n");
}

Json crossings_json(const Model& model, std::span<const Crossing> crossings) {
  Json list = Json::array();
  for (const Crossing& c : crossings) {
    const ContactModel& contact = *model.contact;
    const auto name = [&](int body) { return contact.names[static_cast<std::size_t>(body)]; };
    const auto face = [&](int triangle) {
      const int number = triangle < 0 ? -1 : contact.faces[static_cast<std::size_t>(triangle)];
      return number < 0 ? Json(nullptr) : Json(number);
    };
    const char* kind = c.kind == Crossing::Kind::crossing    ? "crossing"
                       : c.kind == Crossing::Kind::too_close ? "too close"
                                                             : "beneath";
    list.push_back({{"kind", kind},
                    {"bodies", {name(c.first_body), name(c.second_body)}},
                    {"faces", {face(c.first_triangle), face(c.second_triangle)}},
                    {"at", vector(c.at)}});
  }
  return list;
}

std::string as_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string steps_text(const TimeSettings& time) {
  if (!time.steps_per_frame)
    return fmt::format("steps as the motion needs them, of at most {:.4g} s,", time.step());
  const std::int64_t steps = std::int64_t{time.frames()} * *time.steps_per_frame;
  return fmt::format("{} steps of {:.4g} s", steps, time.step());
}

std::vector<WrongSide> wrong_sides_of(const Model& model) {
  return model.contact ? find_wrong_sides(model.contact, model.rest_positions) : std::vector<WrongSide>();
}

std::string solver_text(const SolverSettings& solver) {
  const std::string& name = name_of(integrator_names(), solver.integrator);
  if (solver.integrator != Integrator::implicit_euler && solver.integrator != Integrator::bdf2) return name;
  std::string effort = name_of(effort_names(), solver.effort);
  for (std::size_t k = 1; k < solver.effort_keys.size(); ++k)
    effort += fmt::format(", {} from {:.4g} s", name_of(effort_names(), solver.effort_keys[k].value),
                          solver.effort_keys[k].time);
  if (!solver.tolerance && !solver.effort_keys.empty()) return fmt::format("{}, effort {}", name, effort);
  return fmt::format("{}, effort {}, tolerance {:.3g}", name, effort, solver.error_tolerance());
}

}  // namespace

std::string describe_json(const Model& model, std::span<const Crossing> crossings) {
  const Scene& scene = model.scene;
  const std::optional<int>& fixed = scene.time.steps_per_frame;
  Json json;
  json["title"] = scene.title;
  json["time"] = {{"duration", scene.time.duration},
                  {"frames", scene.time.frames()},
                  {"steps_per_frame", fixed ? Json(*fixed) : Json("auto")},
                  {"steps", fixed ? Json(std::int64_t{scene.time.frames()} * *fixed) : Json(nullptr)},
                  {"step", fixed ? Json(scene.time.step()) : Json(nullptr)},
                  {"stable_step", finite(stable_step(model))}};
  json["integrator"] = name_of(integrator_names(), scene.solver.integrator);
  json["effort"] = name_of(effort_names(), scene.solver.effort);
  json["tolerance"] = scene.solver.error_tolerance();
  json["bodies"] = list_of(model, false);
  json["colliders"] = list_of(model, true);
  json["contact"] = contact_json(model);
  json["crossings"] = crossings_json(model, crossings);
  json["wrong_sides"] = Json::array();
  for (const WrongSide& side : wrong_sides_of(model)) {
    const auto name = [&](int body) { return model.contact->names[static_cast<std::size_t>(body)]; };
    json["wrong_sides"].push_back({{"body", name(side.body)},
                                   {"of", name(side.other)},
                                   {"points", side.points},
                                   {"depth", side.depth}});
  }
  json["pins"] = Json::array();
  for (const Pin& pin : model.pins) {
    json["pins"].push_back({{"name", pin.name}, {"vertices", pin.vertices.size()}});
  }
  json["attachments"] = Json::array();
  for (const Attached& attached : model.attachments)
    json["attachments"].push_back({{"name", attached.name}, {"joints", attached.places.size()}});
  json["forces"] = Json::array();
  for (const ForceSettings& force : scene.forces) {
    json["forces"].push_back({{"name", force.name}, {"type", force.type}});
  }
  json["probes"] = Json::array();
  for (const Probe& probe : model.probes) json["probes"].push_back({{"name", probe.name}});
  json["warnings"] = model.warnings;
  return as_text(json);
}

std::string statistics_json(const Model& model) {
  Json json = {{"bodies", list_of(model, false)}};
  json["colliders"] = list_of(model, true);
  return as_text(json);
}

std::string describe_text(const Model& model, std::span<const Crossing> crossings) {
  const Scene& scene = model.scene;
  std::string text = scene.title + "\n";
  for (const Component& body : model.bodies) text += body.description() + maps_text(body);
  if (model.contact) text += contact_text(*model.contact);
  for (const Pin& pin : model.pins) {
    text +=
        fmt::format("pin {}: {}\n", pin.name, counted(pin.vertices.size(), "held vertex", "held vertices"));
  }
  for (const Attached& attached : model.attachments)
    text += fmt::format("attachment {}: {}\n", attached.name, counted(attached.places.size(), "joint"));
  if (!scene.pressures.empty()) text += counted(scene.pressures.size(), "pressure") + ", ";
  text += counted(scene.forces.size(), "force") + ", " + counted(scene.probes.size(), "probe") + "\n";
  text += fmt::format("{:.6g} s in {} frames, {} by {}", scene.time.duration, scene.time.frames(),
                      steps_text(scene.time), solver_text(scene.solver));
  const double stable = stable_step(model);  // infinite without springs
  text += std::isfinite(stable) ? fmt::format(" (symplectic_euler would need steps below {:.3g} s)\n", stable)
                                : "\n";
  for (const std::string& warning : model.warnings) text += "warning: " + warning + "\n";
  if (!crossings.empty())
    text += counted(crossings.size(), "place", "places") + " where surfaces cross or are too close:\n";
  for (std::size_t i = 0; i < std::min(crossings.size(), max_crossings); ++i)
    text += "  " + describe(*model.contact, crossings[i]) + "\n";
  if (crossings.size() > max_crossings)
    text += fmt::format("  and {} more\n", crossings.size() - max_crossings);
  for (const WrongSide& side : wrong_sides_of(model)) text += describe(*model.contact, side) + "\n";
  return text;
}

std::string describe_json(const MeshReport& r, const std::string& file) {
  Json json;
  json["mesh"] = file;
  json["vertices"] = r.vertices;
  json["faces"] = r.faces;
  json["triangles"] = r.triangles;
  json["components"] = r.components;
  json["open_edges"] = r.open_edges;
  json["non_manifold_edges"] = r.non_manifold_edges;
  json["flipped_edges"] = r.flipped_edges;
  json["degenerate_faces"] = r.degenerate_faces;
  json["duplicate_faces"] = r.duplicate_faces;
  json["unused_vertices"] = r.unused_vertices;
  json["near_border_vertices"] = r.near_border_vertices;
  json["near_border_distance"] = r.near_border_distance;
  json["area"] = r.area;
  json["volume"] = r.volume;
  json["closed"] = r.closed;
  json["min"] = vector(r.bounds.min());
  json["max"] = vector(r.bounds.max());
  json["warnings"] = r.warnings;
  return as_text(json);
}

std::string describe_text(const MeshReport& r, const std::string& file) {
  const Vec3 size = r.bounds.sizes();
  std::string text = file + "\n";
  text +=
      fmt::format("  {}, {} ({}), {}\n", counted(r.vertices, "vertex", "vertices"), counted(r.faces, "face"),
                  counted(r.triangles, "triangle"), counted(r.components, "component"));
  text +=
      fmt::format("  size {:.6g} x {:.6g} x {:.6g} m, area {:.6g} m²", size.x(), size.y(), size.z(), r.area);
  text += r.closed ? fmt::format(", closed, volume {:.6g} m³\n", r.volume)
                   : fmt::format(", open along {}\n", counted(r.open_edges, "edge"));
  for (const std::string& warning : r.warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace muslin
