#include "muslin/scene/force_kind.hpp"

#include <algorithm>

#include "muslin/scene/common_keys.hpp"
#include "muslin/schema/keyframe_keys.hpp"

namespace muslin {

using schema::Key;

schema::Declaration force_body_key(const char* otherwise, const char* meaning) {
  return schema::text("body", &ForceSettings::body)
      .otherwise(otherwise)
      .means(meaning)
      .shown_as<ForceSettings>([](const ForceSettings& force) {
        return force.body.empty() ? schema::null() : schema::words(force.body);
      });
}

schema::Table force_keyframe_table(const char* kind, const char* key, const char* unit) {
  return schema::table_of<Keyed::Key>(fmt::format("keyframes of {}", kind),
                                      {schema::number("time", &Keyed::Key::time)
                                           .unit("s")
                                           .required()
                                           .means("time of the keyframe, later than the previous one"),
                                       schema::vector("value", &Keyed::Key::value)
                                           .unit(unit)
                                           .required()
                                           .means(fmt::format("`{}` at that time", key)),
                                       schema::interpolation_key<Keyed::Key>()});
}

void add_value_keys(schema::Table& table, const ForceValue& value) {
  Key constant = schema::custom<ForceSettings>(
                     value.key, {schema::Type::vector},
                     [](const Key& key, const TomlTable& given, ForceSettings& force) {
                       force.value.keys = {{0, given.vector(key.name, key.unit)}};
                     },
                     [](const Key& key, const ForceSettings& force, TomlValue& out) {
                       if (force.value.keys.size() == 1)
                         schema::append(out, key.name, schema::vector_value(force.value.keys.front().value));
                     })
                     .unit(value.unit)
                     .means(value.meaning)
                     .excludes("keyframes",
                               fmt::format("`{}` is given twice, as constant and by `keyframes`", value.key));
  if (value.otherwise != nullptr) {
    constant.otherwise = value.otherwise;
  } else {
    constant.required = true;
    constant.unless = {"keyframes"};
  }
  table.keys.push_back(constant);
  table.keys.push_back(schema::within<ForceSettings>(
      &ForceSettings::value,
      schema::keyframes("keyframes", &Keyed::keys, value.keyframes)
          .shown_if<Keyed>([](const Keyed& keyed) { return keyed.keys.size() != 1; })
          .otherwise("none")
          .means("the value over time in place of a constant: a list of tables; times ascend")));
  for (Key& key : window_keys(&ForceSettings::from, &ForceSettings::until, "time when it begins to act",
                              "time when it ends, after `from`", "no end"))
    table.keys.push_back(key);
  schema::add_rule<ForceSettings>(table, [](const ForceSettings& force, const schema::Subject& subject) {
    if (force.value.keys.empty()) throw subject.error("", "it has no value", "give at least one key");
  });
}

std::vector<double> masses_acted_on(const Model& model, const ForceSettings& force) {
  std::vector<double> masses(model.vertex_count(), 0.0);
  for (const Component& body : model.bodies) {
    if (!force.acts_on(body.name)) continue;
    const auto first = static_cast<std::ptrdiff_t>(body.first_vertex);
    std::copy_n(model.masses.begin() + first, body.vertex_count, masses.begin() + first);
  }
  return masses;
}

}  // namespace muslin
