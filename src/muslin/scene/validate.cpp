#include "muslin/scene/validate.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/nearest_name.hpp"
#include "muslin/scene/read_body.hpp"

namespace muslin {
namespace {

/// Names what is checked, such as: [[pin]] `top`.
class Checked {
 public:
  Checked(const std::string& table, const std::string& name, Place place)
      : what_(name.empty() ? table : table + " `" + name + "`"), place_(std::move(place)) {}

  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw Error(ErrorKind::input, place_, what_ + ": " + problem, remedy);
  }
  /// The number must be finite and at least `least`.
  void number(const char* key, double value, double least) const {
    if (!(value >= least) || std::isinf(value))
      fail(fmt::format("`{}` is {}", key, value), fmt::format("give a finite number of at least {}", least));
  }
  void positive(const char* key, double value) const {
    if (!(value > 0) || std::isinf(value))
      fail(fmt::format("`{}` is {}", key, value), "give a finite number above 0");
  }
  void vector(const char* key, const Vec3& value) const {
    if (!value.allFinite()) fail(fmt::format("`{}` is not finite", key), "give three finite numbers");
  }
  void window(double from, double until) const {
    if (!std::isfinite(from) || !(until > from))
      fail(fmt::format("it acts from {} until {} s", from, until), "let `until` be later than `from`");
  }
  template <class Key>
  void keys(const std::vector<Key>& keys) const {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (!std::isfinite(keys[i].time) || (i > 0 && !(keys[i].time > keys[i - 1].time)))
        fail(fmt::format("keyframe {} is at {} s", i, keys[i].time), "give times that ascend");
    }
  }
  void name_of(const char* kind, const std::string& name, const std::vector<std::string>& known) const {
    if (std::find(known.begin(), known.end(), name) == known.end())
      fail(fmt::format("there is no {} `{}`", kind, name),
           known.empty() ? "the scene has none" : name_advice(name, known));
  }

 private:
  std::string what_;
  Place place_;
};

void check_solver(const Scene& scene) {
  const Checked time("[time]", "", {}), solver("[solver]", "", {}),
      contact("[contact]", "", scene.contact.place);
  time.number("duration", scene.time.duration, 0);
  time.positive("frame_rate", scene.time.frame_rate);
  if (scene.time.steps_per_frame) time.number("steps_per_frame", *scene.time.steps_per_frame, 1);
  if (scene.solver.tolerance) solver.positive("tolerance", *scene.solver.tolerance);
  solver.positive("linear_tolerance", scene.solver.linear_tolerance);
  if (scene.contact.distance) contact.positive("distance", *scene.contact.distance);
  contact.number("friction", scene.contact.friction, 0);
}

void check_shell(const Checked& body, const BodySettings& settings) {
  if (!settings.material.shell)
    body.fail("its material has no numbers for shells", "set `material.shell`, or choose the lattice");
  const ShellMaterial& shell = *settings.material.shell;
  body.positive("areal_density", shell.areal_density);
  body.number("membrane_warp", shell.membrane_warp, 0);
  body.number("membrane_weft", shell.membrane_weft, 0);
  body.number("membrane_shear", shell.membrane_shear, 0);
  if (!(std::abs(shell.poisson) < 1))
    body.fail(fmt::format("`poisson` is {}", shell.poisson), "give less than 1");
  body.number("bending_warp", shell.bending_warp, 0);
  body.number("bending_weft", shell.bending_weft, 0);
  body.number("bending_bias", shell.bending_bias, 0);
  body.number("mass_damping", shell.mass_damping, 0);
  body.number("stiffness_damping", shell.stiffness_damping, 0);
  body.number("bending_damping", shell.bending_damping, 0);
  if (settings.stretch_limit) body.number("stretch_limit", *settings.stretch_limit, least_stretch_limit);
  if (settings.shell_thickness) body.number("thickness", *settings.shell_thickness, 0);
}

void check_lattice(const Checked& body, const BodySettings& settings) {
  const Material& material = settings.material;
  if (!material.has_lattice)
    body.fail("its material has no numbers for lattices", "set them, or choose the shell");
  body.positive("voxel_width", settings.lattice.width);
  body.positive("density", material.density);
  body.number("edge_modulus", material.edge_modulus, 0);
  body.number("face_diagonal_modulus", material.face_diagonal_modulus, 0);
  body.number("body_diagonal_modulus", material.body_diagonal_modulus, 0);
  body.number("volume_modulus", material.volume_modulus, 0);
  body.number("young_modulus", material.young_modulus, 0);
  if (material.young_modulus > 0 && !(material.poisson > -1 && material.poisson < 0.5))
    body.fail("its `poisson` is not between -1 and 0.5", "give 0 to 0.49");
  body.number("mass_damping", material.mass_damping, 0);
  body.number("stiffness_damping", material.stiffness_damping, 0);
  if (settings.thickness) body.positive("thickness", *settings.thickness);
}

void check_body(const BodySettings& settings) {
  const Checked body("[[body]]", settings.name, settings.place);
  if (settings.model == BodyModel::shell) {
    check_shell(body, settings);
  } else if (settings.model == BodyModel::lattice) {
    check_lattice(body, settings);
  } else {
    body.fail("its model is that of a collider", "use BodyModel::lattice or BodyModel::shell");
  }
  body.vector("translate", settings.translate);
  body.vector("rotate", settings.rotate);
  body.vector("scale", settings.scale);
  body.vector("velocity", settings.velocity);
  if (settings.friction) body.number("friction", *settings.friction, 0);
}

void check_collider(const ColliderSettings& settings) {
  using Shape = ColliderSettings::Shape;
  const Checked collider("[[collider]]", settings.name, settings.place);
  collider.vector("center", settings.center);
  if (settings.shape == Shape::plane && !(std::abs(settings.normal.norm() - 1) <= 1e-9))
    collider.fail("`normal` is not of length 1", "normalise it");
  if (settings.shape == Shape::sphere || settings.shape == Shape::capsule)
    collider.positive("radius", settings.radius);
  if (settings.shape == Shape::box) collider.positive("size", settings.size.minCoeff());
  collider.vector("size", settings.size);
  collider.vector("points", settings.points[0] + settings.points[1]);
  collider.vector("translate", settings.translate);
  collider.vector("rotate", settings.rotate);
  collider.vector("scale", settings.scale);
  collider.vector("velocity", settings.velocity);
  collider.vector("angular_velocity", settings.angular_velocity);
  collider.keys(settings.motion.keys);
  if (settings.friction) collider.number("friction", *settings.friction, 0);
  if (!settings.sequence.empty() && !settings.motion.keys.empty())
    collider.fail("it has both keyframes and a sequence", "give one of them");
  if (!settings.is_free()) return;
  collider.positive("density", *settings.density);
  if (settings.shape == Shape::plane)
    collider.fail("a plane has a `density`", "take it out: planes stand still");
  if (!settings.sequence.empty() || !settings.motion.keys.empty())
    collider.fail("it has a `density` and a prescribed motion", "give one of them");
}

void check_force(const Scene& scene, const ForceSettings& settings, const std::vector<std::string>& movable) {
  using Type = ForceSettings::Type;
  const Checked force("[[force]]", settings.name, settings.place);
  if (!settings.body.empty() || settings.type == Type::point) force.name_of("body", settings.body, movable);
  const bool is_soft = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                   [&](const BodySettings& body) { return body.name == settings.body; });
  if (settings.type == Type::point && is_soft && !settings.where)
    force.fail("a point force has no `where`", "select the vertices it acts on");
  if (settings.value.keys.empty()) force.fail("it has no value", "give at least one key");
  force.keys(settings.value.keys);
  for (const Keyed::Key& key : settings.value.keys) force.vector("value", key.value);
  force.window(settings.from, settings.until);
  force.number("air_density", settings.air_density, 0);
  force.number("drag", settings.drag, 0);
  force.number("lift", settings.lift, 0);
  force.number("gust", settings.gust, 0);
  force.positive("gust_length", settings.gust_length);
}

}  // namespace

void validate(const Scene& scene) {
  check_solver(scene);
  std::set<std::string> names;
  std::vector<std::string> movable;
  const auto add = [&](const char* table, const auto& settings, bool moves) {
    const Checked checked(table, settings.name, settings.place);
    if (settings.name.empty()) checked.fail("it has no name", "give it one");
    if (!names.insert(settings.name).second)
      checked.fail("another one has its name", "give each a name of its own");
    if (moves) movable.push_back(settings.name);
  };
  for (const BodySettings& body : scene.bodies) add("[[body]]", body, true);
  for (const ColliderSettings& collider : scene.colliders) add("[[collider]]", collider, collider.is_free());
  for (const BodySettings& body : scene.bodies) check_body(body);
  for (const ColliderSettings& collider : scene.colliders) check_collider(collider);
  for (const ForceSettings& force : scene.forces) check_force(scene, force, movable);
  for (const PinSettings& settings : scene.pins) {
    const Checked pin("[[pin]]", settings.name, settings.place);
    pin.name_of("body", settings.body, movable);
    pin.window(settings.from, settings.until);
    pin.keys(settings.motion.keys);
    if (!settings.sequence.empty() && !settings.motion.keys.empty())
      pin.fail("it has both keyframes and a sequence", "give one of them");
  }
  for (const ProbeSettings& settings : scene.probes) {
    const Checked probe("[[probe]]", settings.name, settings.place);
    probe.name_of("body", settings.body, movable);
    probe.vector("at", settings.at);
  }
  for (const auto& [name, mesh] : scene.meshes)
    if (!mesh) throw Error(ErrorKind::input, "the mesh `" + name + "` is null", "give one that exists");
}

}  // namespace muslin
