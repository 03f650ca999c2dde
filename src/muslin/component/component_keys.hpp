// Declares keys that several tables of components have, and names that can stand in a scene file.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "muslin/component/body_settings.hpp"
#include "muslin/component/collider/collider_settings.hpp"
#include "muslin/constraint/pin.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {

/// Throws Error(input) unless `name` is valid in file names and paths: not empty, no separators or control
/// characters.
void require_name(const std::string& name, const Place& place);

/// The key `name`; `otherwise` states the name where it is not given.
template <class S>
schema::Declaration name_key(std::string otherwise) {
  return schema::custom<S>(
             "name", {schema::Type::text},
             [](const schema::Key& key, const TomlTable& table, S& s) {
               s.name = table.string(key.name);
               require_name(s.name, table.place(key.name));
             },
             [](const schema::Key& key, const S& s, TomlValue& out) {
               schema::append(out, key.name, schema::words(s.name));
             })
      .otherwise(std::move(otherwise));
}

/// The key `scale`: a number or one per axis.
schema::Declaration scale_key(Vec3 BodySettings::* member);
schema::Declaration scale_key(Vec3 ColliderSettings::* member);

/// Why thickness and distance of contact have no keyframes.
constexpr const char* steady_thickness = "surfaces that thicken would cross those that they touch";
constexpr const char* steady_distance = "a longer one would throw apart what rests within it";

template <class S>
schema::Declaration friction_key(std::optional<double> S::* member) {
  return schema::number("friction", member)
      .range({0, 100, false})
      .may_change_on_resume()
      .otherwise("that of `[contact]`")
      .means("Coulomb's coefficient of its surface; a [pair](#contact) has the geometric mean");
}

/// The key `layer`.
template <class S>
schema::Declaration layer_key(std::optional<int> S::* member) {
  return schema::whole_number("layer", member)
      .range({0, 1000, false})
      .otherwise("none")
      .means(
          "order outward (skin 0, shirt 1, jacket 2): at a [tangled start](contact.md#a-tangled-start) a "
          "body "
          "belongs outside those of lower layers");
}

/// `keyframes` of a motion.
schema::Declaration motion_key();

}  // namespace muslin
