#include "muslin/scene/common_keys.hpp"

#include <algorithm>

#include "muslin/core/nearest_name.hpp"
#include "muslin/schema/keyframe_keys.hpp"

namespace muslin {

void check_window(double from, double until, const schema::Subject& subject) {
  if (!(until > from))
    throw subject.error("until", fmt::format("`until` = {} s is not after `from` = {} s", until, from),
                        "let it end after it begins");
}

const schema::Table& keyed_number_table() {
  static const schema::Table table = schema::table_of<KeyedNumber>(
      "a number over time",
      {schema::keyframes("keyframes", &KeyedNumber::keys, schema::number_keyframe_table)
           .required()
           .means("a list of tables; times ascend; constant before the first and after the last")});
  return table;
}

void read_keyed_number(const schema::Key& key, const TomlTable& table, KeyedNumber& number) {
  const TomlValue& value = *table.find(key.name);
  if (value.type != TomlValue::Type::table) {
    number.keys = {{0, table.number(key.name, key.unit, key.range)}};
    return;
  }
  const TomlTable over_time =
      keyed_number_table().open(value, fmt::format("`{}` of {}", key.name, table.title()));
  keyed_number_table().read(over_time, number);
  for (const KeyedNumber::Key& keyframe : number.keys)
    if (!fits(keyframe.value, key.range))
      throw table.error(key.name, fmt::format("`{}` is {} at {} s", key.name, keyframe.value, keyframe.time),
                        fmt::format("give {}", schema::described(key)));
}

void write_keyed_number(const schema::Key& key, const KeyedNumber& number, TomlValue& out) {
  schema::append(
      out, key.name,
      number.is_constant() ? schema::real(number.keys.front().value) : keyed_number_table().write(number));
}

void check_keyed_number(const schema::Key& key, const KeyedNumber& number, const schema::Subject& subject) {
  if (number.keys.empty()) throw subject.error(key.name, "it has no value", "give at least one key");
  keyed_number_table().check(number, subject);
  for (const KeyedNumber::Key& keyframe : number.keys)
    if (!fits(keyframe.value, key.range))
      throw subject.error(key.name, fmt::format("`{}` is {}", key.name, keyframe.value),
                          fmt::format("give {}", schema::described(key)));
}

std::vector<std::string> movable_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const BodySettings& body : scene.bodies) names.push_back(body.name);
  for (const ColliderSettings& collider : scene.colliders)
    if (collider.is_free()) names.push_back(collider.name);
  for (const ComponentSource& component : scene.components) names.push_back(component.name);
  return names;
}

std::vector<std::string> all_names(const Scene& scene) {
  std::vector<std::string> names = movable_names(scene);
  for (const ColliderSettings& collider : scene.colliders)
    if (!collider.is_free()) names.push_back(collider.name);
  return names;
}

bool is_rigid(const Scene& scene, const std::string& name) {
  return std::any_of(scene.colliders.begin(), scene.colliders.end(),
                     [&](const ColliderSettings& collider) { return collider.name == name; });
}

void require_movable(const Scene& scene) {
  if (!movable_names(scene).empty()) return;
  throw Error(ErrorKind::input, {scene.file.string(), 0, 0}, "the scene has no body",
              "add a [[body]] with `mesh`, `material` and `voxel_width`, or `model = \"shell\"`");
}

void resolve_body(const TomlTable& table, const Scene& scene, bool all_allowed, std::string& body) {
  require_movable(scene);
  const std::vector<std::string> names = movable_names(scene);
  if (!table.has("body")) {
    if (all_allowed) return;
    if (scene.bodies.size() == 1 || names.size() == 1) {
      body = names.front();
      return;
    }
    throw Error(ErrorKind::input, table.place(),
                fmt::format("{} does not say which of the {} bodies it means", table.title(), names.size()),
                "add `body = …`, one of " + name_list(names));
  }
  if (std::find(names.begin(), names.end(), body) != names.end()) return;
  if (is_rigid(scene, body)) {
    throw table.error("body",
                      fmt::format("the collider `{}` has no mass, so nothing holds or pushes it", body),
                      "give it a `density`, or move it by `keyframes` of its own");
  }
  throw table.error("body", fmt::format("there is no body `{}`", body), name_advice(body, names));
}

void complete_name(const TomlTable& table, const std::string& fallback, std::string& name) {
  if (table.has("name")) return;
  name = fallback;
  require_name(name, table.place());
}

void refuse_name(const TomlTable& table, const std::string& other_kind, const std::string& kind,
                 const std::string& name) {
  const std::string both = other_kind == kind ? fmt::format("two of [[{}]]", kind)
                                              : fmt::format("a [[{}]] and a [[{}]]", other_kind, kind);
  throw table.error("name", fmt::format("there are {} called `{}`", both, name),
                    "give each a `name` of its own");
}

}  // namespace muslin
