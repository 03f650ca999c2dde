#include "muslin/scene/resolved.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "muslin/scene/names.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json vector(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json selection(const Selection& where) {
  Json json = Json::object();
  if (where.group) json["group"] = *where.group;
  if (where.box) json["box"] = Json::array({vector(where.box->min), vector(where.box->max)});
  if (where.sphere) {
    json["sphere"] = {{"center", vector(where.sphere->center)}, {"radius", where.sphere->radius}};
  }
  if (where.plane) {
    json["plane"] = {{"point", vector(where.plane->point)}, {"normal", vector(where.plane->normal)}};
    if (where.plane->distance) json["plane"]["distance"] = *where.plane->distance;
  }
  if (where.line) {
    json["line"] = {{"from", vector(where.line->a)}, {"to", vector(where.line->b)}};
    if (where.line->distance) json["line"]["distance"] = *where.line->distance;
  }
  if (!where.nearest.empty()) {
    json["nearest"] = Json::array();
    for (const Vec3& point : where.nearest) json["nearest"].push_back(vector(point));
  }
  return json;
}

Json material(const Material& m) {
  Json json = {{"name", m.name},
               {"density", m.density},
               {"edge_modulus", m.edge_modulus},
               {"face_diagonal_modulus", m.face_diagonal_modulus},
               {"body_diagonal_modulus", m.body_diagonal_modulus},
               {"volume_modulus", m.volume_modulus},
               {"mass_damping", m.mass_damping},
               {"stiffness_damping", m.stiffness_damping}};
  if (m.young_modulus > 0) {
    json["young_modulus"] = m.young_modulus;
    json["poisson"] = m.poisson;
  }
  return json;
}

Json shell_material(const Material& material) {
  const ShellMaterial& m = *material.shell;
  return {{"name", material.name},
          {"areal_density", m.areal_density},
          {"membrane_warp", m.membrane_warp},
          {"membrane_weft", m.membrane_weft},
          {"membrane_shear", m.membrane_shear},
          {"poisson", m.poisson},
          {"bending_warp", m.bending_warp},
          {"bending_weft", m.bending_weft},
          {"bending_bias", m.bending_bias},
          {"mass_damping", m.mass_damping},
          {"stiffness_damping", m.stiffness_damping},
          {"bending_damping", m.bending_damping}};
}

void add_lattice(const BodySettings& b, Json& json) {
  json["thickness"] = b.thickness.value_or(b.lattice.width);
  json["voxel_width"] = b.lattice.width;
  json["voxels"] = name_of(voxel_rule_names(), b.lattice.rule);
  if (b.lattice.rule == VoxelRule::threshold) json["threshold"] = b.lattice.threshold;
  json["bracing"] = name_of(bracing_names(), b.bracing);
  json["mass"] = name_of(mass_names(), b.mass);
  json["boundary_springs"] = name_of(boundary_spring_names(), b.boundary_springs);
  json["material"] = material(b.material);
}

void add_shell(const BodySettings& b, Json& json) {
  if (b.shell_thickness) json["thickness"] = *b.shell_thickness;
  if (!b.rest_mesh.empty()) json["rest_mesh"] = b.rest_mesh;
  if (b.warp) json["warp"] = vector(*b.warp);
  if (b.stretch_limit) json["stretch_limit"] = *b.stretch_limit;
  json["material"] = shell_material(b.material);
}

Json body(const BodySettings& b) {
  Json json = {{"name", b.name}, {"mesh", b.mesh}, {"model", name_of(body_model_names(), b.model)}};
  if (b.model == BodyModel::shell) {
    add_shell(b, json);
  } else {
    add_lattice(b, json);
  }
  json["translate"] = vector(b.translate);
  json["rotate"] = vector(b.rotate);
  json["scale"] = vector(b.scale);
  json["velocity"] = vector(b.velocity);
  json["contact"] = b.contact;
  json["self_contact"] = b.self_contact;
  if (b.friction) json["friction"] = *b.friction;
  if (b.colour) json["colour"] = vector(*b.colour);
  return json;
}

Json keyframes(const Motion& motion) {
  Json json = Json::array();
  for (const Motion::Key& key : motion.keys) {
    json.push_back({{"time", key.time},
                    {"translate", vector(key.translate)},
                    {"quaternion", {key.rotate.w(), key.rotate.x(), key.rotate.y(), key.rotate.z()}}});
  }
  return json;
}

void add_shape(const ColliderSettings& c, Json& json) {
  using Shape = ColliderSettings::Shape;
  if (c.shape == Shape::plane || c.shape == Shape::sphere || c.shape == Shape::box)
    json["center"] = vector(c.center);
  if (c.shape == Shape::plane) json["normal"] = vector(c.normal);
  if (c.shape == Shape::capsule) json["points"] = {vector(c.points[0]), vector(c.points[1])};
  if (c.shape == Shape::sphere || c.shape == Shape::capsule) json["radius"] = c.radius;
  if (c.shape == Shape::box) json["size"] = vector(c.size);
  if (c.shape == Shape::mesh) {
    json["mesh"] = c.mesh;
    json["translate"] = vector(c.translate);
  }
  if (c.shape == Shape::box || c.shape == Shape::mesh) json["rotate"] = vector(c.rotate);
  if (c.shape == Shape::mesh) json["scale"] = vector(c.scale);
}

Json collider(const ColliderSettings& c) {
  Json json = {{"name", c.name}, {"shape", name_of(collider_shape_names(), c.shape)}};
  add_shape(c, json);
  if (c.is_free()) {
    json["density"] = *c.density;
    json["velocity"] = vector(c.velocity);
    json["angular_velocity"] = vector(c.angular_velocity);
  } else {
    if (!c.sequence.empty()) json["sequence"] = c.sequence;
    if (c.frame_rate) json["frame_rate"] = *c.frame_rate;
    if (c.start) json["start"] = *c.start;
    if (c.pivot) json["pivot"] = vector(*c.pivot);
    json["keyframes"] = keyframes(c.motion);
  }
  json["contact"] = c.contact;
  if (c.friction) json["friction"] = *c.friction;
  if (c.colour) json["colour"] = vector(*c.colour);
  return json;
}

/// The contact distance is null where it is chosen from the bodies.
Json contact(const ContactSettings& c) {
  return {{"distance", c.distance ? Json(*c.distance) : Json(nullptr)},
          {"friction", c.friction}};
}

Json pin(const PinSettings& p) {
  Json json = {{"name", p.name}, {"body", p.body}, {"where", selection(p.where)}};
  json["from"] = number(p.from);
  json["until"] = number(p.until);
  if (p.pivot) json["pivot"] = vector(*p.pivot);
  if (!p.sequence.empty()) json["sequence"] = p.sequence;
  json["keyframes"] = keyframes(p.motion);
  return json;
}

Json force(const ForceSettings& f) {
  Json json = {{"name", f.name}, {"type", name_of(force_type_names(), f.type)}};
  json["body"] = f.body.empty() ? Json(nullptr) : Json(f.body);
  if (f.where) json["where"] = selection(*f.where);
  if (f.value.keys.size() == 1) {
    json[name_of(force_value_names(), f.type)] = vector(f.value.keys.front().value);
  } else {
    json["keyframes"] = Json::array();
    for (const Keyed::Key& key : f.value.keys) {
      json["keyframes"].push_back({{"time", key.time}, {"value", vector(key.value)}});
    }
  }
  json["from"] = number(f.from);
  json["until"] = number(f.until);
  if (f.type == ForceSettings::Type::wind) {
    json["air_density"] = f.air_density;
    json["drag"] = f.drag;
    json["lift"] = f.lift;
    json["gust"] = f.gust;
    json["gust_length"] = f.gust_length;
    json["seed"] = f.seed;
  }
  return json;
}

Json steps_json(const TimeSettings& time) {
  return time.steps_per_frame ? Json(*time.steps_per_frame) : Json("auto");
}

template <class Settings, class Convert>
Json list(const std::vector<Settings>& items, const Convert& convert) {
  Json json = Json::array();
  for (const Settings& item : items) json.push_back(convert(item));
  return json;
}

}  // namespace

std::string resolved_json(const Scene& scene) {
  Json json;
  json["title"] = scene.title;
  json["time"] = {{"duration", scene.time.duration},
                  {"frame_rate", scene.time.frame_rate},
                  {"steps_per_frame", steps_json(scene.time)}};
  json["solver"] = {{"integrator", name_of(integrator_names(), scene.solver.integrator)},
                    {"effort", name_of(effort_names(), scene.solver.effort)},
                    {"tolerance", scene.solver.error_tolerance()},
                    {"linear_tolerance", scene.solver.linear_tolerance}};
  json["body"] = list(scene.bodies, body);
  json["collider"] = list(scene.colliders, collider);
  json["contact"] = contact(scene.contact);
  json["pin"] = list(scene.pins, pin);
  json["force"] = list(scene.forces, force);
  json["probe"] = list(scene.probes, [](const ProbeSettings& p) {
    return Json{{"name", p.name}, {"body", p.body}, {"at", vector(p.at)}};
  });
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace muslin
