#include "muslin/scene/describe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "muslin/contact/contact_model.hpp"
#include "muslin/scene/names.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t max_crossings = 8;  // in a text

Json vector(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }
Json finite(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}
std::string counted(std::size_t count, const std::string& one) { return counted(count, one, one + "s"); }

/// Returns the step below which symplectic_euler is stable for every body [s].
double stable_step(const Model& model) {
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < model.scene.bodies.size(); ++b)
    step = std::min(step, model.bodies[b].statistics.stable_step);
  return step;
}

/// Adds counts reported for every body; may be zero.
void add_counts(const Body& body, const BodySettings& settings, Json& json) {
  const BodyStatistics& s = body.statistics;
  json["material"] = settings.material.name;
  json["vertices"] = s.vertices;
  json["voxels"] = s.voxels;
  json["tetrahedra"] = s.tetrahedra;
  json["springs"] = {
      {"edge", s.springs[0]}, {"face_diagonal", s.springs[1]}, {"body_diagonal", s.springs[2]}};
  json["mass"] = s.mass;
  json["coverage"] = s.coverage;
}

Json body_json(const Body& body, const BodySettings& settings) {
  const BodyStatistics& s = body.statistics;
  Json json;
  json["name"] = body.name;
  json["mesh"] = settings.mesh;
  json["model"] = name_of(body_model_names(), body.model);
  if (body.is_shell()) {
    json["triangles"] = s.triangles;
    json["hinges"] = s.hinges;
    json["area"] = body.shell.area;
    json["mean_edge"] = body.shell.mean_edge;
    if (settings.stretch_limit) json["stretch_limit"] = *settings.stretch_limit;
    json["warp"] = settings.warp ? "given" : body.mesh.corner_uvs.empty() ? "longest side" : "texture";
    add_counts(body, settings, json);
    json["stable_step"] = finite(s.stable_step);
    return json;
  }
  json["kind"] = body.sheet ? "sheet" : "solid";
  if (body.sheet) json["thickness"] = body.thickness;
  json["voxel_width"] = body.lattice.width;
  json["extent"] = {body.lattice.extent.x(), body.lattice.extent.y(), body.lattice.extent.z()};
  add_counts(body, settings, json);
  json["contour"] = body.contour.method == ContourMethod::squares ? "squares" : "cubes";
  json["contour_distance"] = s.contour_distance;
  json["stable_step"] = finite(s.stable_step);
  return json;
}

Json bodies_json(const Model& model) {
  Json bodies = Json::array();
  for (std::size_t b = 0; b < model.scene.bodies.size(); ++b)
    bodies.push_back(body_json(model.bodies[b], model.scene.bodies[b]));
  return bodies;
}

/// Returns the kind of motion of a collider.
std::string movement(const ColliderSettings& settings) {
  if (settings.is_free()) return "rigid body";
  return !settings.sequence.empty() ? "sequence" : settings.motion.keys.empty() ? "fixed" : "keyframed";
}

Json colliders_json(const Model& model) {
  Json colliders = Json::array();
  for (std::size_t c = 0; c < model.scene.colliders.size(); ++c) {
    const ColliderSettings& settings = model.scene.colliders[c];
    const Body& body = model.collider(c);
    Json json = {{"name", body.name},
                 {"shape", name_of(collider_shape_names(), settings.shape)},
                 {"movement", movement(settings)}};
    if (settings.is_free()) json["mass"] = body.statistics.mass;
    json["vertices"] = body.mesh.vertex_count();
    json["triangles"] = body.statistics.triangles;
    colliders.push_back(json);
  }
  return colliders;
}

/// Returns null if nothing can touch.
Json contact_json(const Model& model) {
  if (!model.contact) return nullptr;
  return {{"distance", model.contact->distance},
          {"friction", model.contact->friction},
          {"triangles", model.contact->surface->triangles().size()}};
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

std::string shell_text(const Body& body, const BodySettings& settings) {
  const BodyStatistics& s = body.statistics;
  const ShellMaterial& m = *settings.material.shell;
  std::string text = fmt::format("body {}: {} ({}, shell)\n", body.name, settings.mesh,
                                 counted(body.mesh.face_count(), "polygon"));
  text += fmt::format("  shell       {} vertices, {} triangles, {} hinges, edges of {:.4g} m on average\n",
                      s.vertices, s.triangles, s.hinges, body.shell.mean_edge);
  text += fmt::format("  mass        {:.6g} kg of {}, {:.4g} kg/m² on {:.6g} m²\n", s.mass,
                      settings.material.name, m.areal_density, body.shell.area);
  text += fmt::format(
      "  stiffness   warp {:.4g}, weft {:.4g}, shear {:.4g} N/m; bending {:.3g}, {:.3g}, bias "
      "{:.3g} N·m\n",
      m.membrane_warp, m.membrane_weft, m.membrane_shear, m.bending_warp, m.bending_weft, m.bending_bias);
  if (settings.stretch_limit)
    text += fmt::format("  limit       stretched to {:.4g} of its length at most\n", *settings.stretch_limit);
  return text;
}

std::string body_text(const Body& body, const BodySettings& settings) {
  if (body.is_shell()) return shell_text(body, settings);
  const BodyStatistics& s = body.statistics;
  const Vec3i& n = body.lattice.extent;
  const std::string kind = body.sheet ? fmt::format("sheet, {:.4g} m thick", body.thickness) : "solid";
  std::string text = fmt::format("body {}: {} ({}, {})\n", body.name, settings.mesh,
                                 counted(body.mesh.face_count(), "polygon"), kind);
  text += fmt::format("  voxels      {} of {:.6g} m in {} x {} x {}, {:.4g} % of the surface covered\n",
                      s.voxels, body.lattice.width, n.x(), n.y(), n.z(), 100 * s.coverage);
  text += fmt::format("  lattice     {} vertices, {} tetrahedra\n", s.vertices, s.tetrahedra);
  text += fmt::format("  springs     {} edge, {} face diagonal, {} body diagonal ({})\n", s.springs[0],
                      s.springs[1], s.springs[2], name_of(bracing_names(), settings.bracing));
  text += fmt::format("  mass        {:.6g} kg of {}\n", s.mass, settings.material.name);
  text +=
      fmt::format("  contour     marching {}, at most {:.3g} m from the mesh\n",
                  body.contour.method == ContourMethod::squares ? "squares" : "cubes", s.contour_distance);
  return text;
}

std::string collider_text(const Model& model, std::size_t index) {
  const ColliderSettings& settings = model.scene.colliders[index];
  const Body& body = model.collider(index);
  std::string text = fmt::format("collider {}: {}, {}", body.name,
                                 settings.shape == ColliderSettings::Shape::mesh
                                     ? settings.mesh
                                     : name_of(collider_shape_names(), settings.shape),
                                 movement(settings));
  if (settings.is_free()) text += fmt::format(" of {:.6g} kg", body.statistics.mass);
  if (settings.shape == ColliderSettings::Shape::mesh)
    text += ", " + counted(static_cast<std::size_t>(body.statistics.triangles), "triangle");
  return text + "\n";
}

std::string steps_text(const TimeSettings& time) {
  if (!time.steps_per_frame)
    return fmt::format("steps as the motion needs them, of at most {:.4g} s,", time.step());
  const std::int64_t steps = std::int64_t{time.frames()} * *time.steps_per_frame;
  return fmt::format("{} steps of {:.4g} s", steps, time.step());
}

std::string solver_text(const SolverSettings& solver) {
  const std::string& name = name_of(integrator_names(), solver.integrator);
  if (solver.integrator != Integrator::implicit_euler && solver.integrator != Integrator::bdf2) return name;
  return fmt::format("{}, effort {}, tolerance {:.3g}", name, name_of(effort_names(), solver.effort),
                     solver.error_tolerance());
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
  json["bodies"] = bodies_json(model);
  json["colliders"] = colliders_json(model);
  json["contact"] = contact_json(model);
  json["crossings"] = crossings_json(model, crossings);
  json["pins"] = Json::array();
  for (const Pin& pin : model.pins) {
    json["pins"].push_back({{"name", pin.name}, {"vertices", pin.vertices.size()}});
  }
  json["forces"] = Json::array();
  for (const ForceSettings& force : scene.forces) {
    json["forces"].push_back({{"name", force.name}, {"type", name_of(force_type_names(), force.type)}});
  }
  json["probes"] = Json::array();
  for (const Probe& probe : model.probes) json["probes"].push_back({{"name", probe.name}});
  json["warnings"] = model.warnings;
  return as_text(json);
}

std::string statistics_json(const Model& model) {
  Json json = {{"bodies", bodies_json(model)}};
  json["colliders"] = colliders_json(model);
  return as_text(json);
}

std::string describe_text(const Model& model, std::span<const Crossing> crossings) {
  const Scene& scene = model.scene;
  std::string text = scene.title + "\n";
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) text += body_text(model.bodies[b], scene.bodies[b]);
  for (std::size_t c = 0; c < scene.colliders.size(); ++c) text += collider_text(model, c);
  if (model.contact) {
    text += fmt::format("contact: within {:.3g} m, friction {:.3g}\n", model.contact->distance,
                        model.contact->friction);
  }
  for (const Pin& pin : model.pins) {
    text +=
        fmt::format("pin {}: {}\n", pin.name, counted(pin.vertices.size(), "held vertex", "held vertices"));
  }
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
