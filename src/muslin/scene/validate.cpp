#include "muslin/scene/validate.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/nearest_name.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/force_kinds.hpp"
#include "muslin/scene/scene_table.hpp"

namespace muslin {
namespace {

using schema::Subject;

template <class Settings>
Subject subject_of(const char* list, const Settings& settings) {
  return {settings.name.empty() ? list : fmt::format("{} `{}`", list, settings.name), settings.place};
}

/// Names of bodies, colliders and components are unique among all.
template <class Settings>
void check_names(const char* list, const std::vector<Settings>& items, std::set<std::string>& names) {
  for (const Settings& item : items) {
    if (item.name.empty()) throw subject_of(list, item).error("name", "it has no name", "give it one");
    if (!names.insert(item.name).second)
      throw subject_of(list, item).error("name", "another one has its name", "give each a name of its own");
  }
}

void check_body_name(const Subject& subject, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  throw subject.error("body", fmt::format("there is no body `{}`", name),
                      known.empty() ? "the scene has none" : name_advice(name, known));
}

void check_force(const Scene& scene, const ForceSettings& force, const std::vector<std::string>& movable) {
  const Subject subject = subject_of("[[force]]", force);
  const ForceKind& kind = kind_of(force);
  if (!force.body.empty() || kind.on_one_body) check_body_name(subject, force.body, movable);
  if (kind.check != nullptr) kind.check(force, scene, subject);
}

}  // namespace

void validate(const Scene& scene) {
  std::set<std::string> names;
  check_names("[[body]]", scene.bodies, names);
  check_names("[[collider]]", scene.colliders, names);
  check_names("component", scene.components, names);
  scene_table().check(scene, Subject("the scene", {scene.file.string()}));
  const std::vector<std::string> movable = movable_names(scene);
  check_contact_pairs(scene);
  for (const ForceSettings& force : scene.forces) check_force(scene, force, movable);
  for (const PressureSettings& pressure : scene.pressures)
    check_body_name(subject_of("[[pressure]]", pressure), pressure.body, movable);
  const std::vector<std::string> all = all_names(scene);  // probes may be on colliders that stand still
  for (const PinSettings& pin : scene.pins) {
    check_body_name(subject_of("[[pin]]", pin), pin.body, movable);
    for (const std::string& body : pin.ignore) check_body_name(subject_of("[[pin]]", pin), body, all);
  }
  for (const AttachmentSettings& attachment : scene.attachments) {
    check_body_name(subject_of("[[attachment]]", attachment), attachment.body, movable);
    check_body_name(subject_of("[[attachment]]", attachment), attachment.to, all);
  }
  for (const ProbeSettings& probe : scene.probes)
    check_body_name(subject_of("[[probe]]", probe), probe.body, all);
  for (const auto& [name, mesh] : scene.meshes)
    if (!mesh) throw Error(ErrorKind::input, "the mesh `" + name + "` is null", "give one that exists");
}

}  // namespace muslin
