#include "muslin/scene/force_table.hpp"

#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/names.hpp"
#include "muslin/scene/selection_table.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

using schema::Key;
using Type = ForceSettings::Type;

constexpr const char* units[] = {"m/s²", "N", "m/s"};  // of the value of each type
const Vec3 standard_gravity(0, -9.8, 0);

template <Type type>
const schema::Table& keyframe_table() {
  constexpr auto index = static_cast<std::size_t>(type);
  static const schema::Table table = schema::table_of<Keyed::Key>(
      fmt::format("keyframes of {}", force_type_names()[index]),
      {schema::number("time", &Keyed::Key::time).unit("s").required().means("after that of the one before"),
       schema::vector("value", &Keyed::Key::value)
           .unit(units[index])
           .required()
           .means(fmt::format("`{}` at that time", force_value_names()[index]))});
  return table;
}

/// The value of a force, constant or over time, and when it acts.
template <Type type>
std::vector<Key> value_keys(const char* meaning) {
  constexpr auto index = static_cast<std::size_t>(type);
  const std::string& name = force_value_names()[index];
  Key constant =
      schema::custom<ForceSettings>(
          name, {schema::Type::vector},
          [](const Key& key, const TomlTable& table, ForceSettings& force) {
            force.value.keys = {{0, table.vector(key.name, key.unit)}};
          },
          [](const Key& key, const ForceSettings& force, TomlValue& out) {
            if (force.value.keys.size() == 1)
              schema::append(out, key.name, schema::vector_value(force.value.keys.front().value));
          })
          .unit(units[index])
          .means(meaning)
          .excludes("keyframes", fmt::format("`{}` is given twice, as constant and by `keyframes`", name));
  if (type == Type::gravity) {
    constant.otherwise = "`[0, -9.8, 0]`";
  } else {
    constant.required = true;
    constant.unless = {"keyframes"};
  }
  Key keyframes =
      schema::within(&ForceSettings::value,
                     schema::keyframes("keyframes", &Keyed::keys, keyframe_table<type>)
                         .template shown_if<Keyed>([](const Keyed& value) { return value.keys.size() != 1; })
                         .otherwise("none")
                         .means("the value over time in place of a constant: a list of tables, linear "
                                "between them; times ascend"));
  std::vector<Key> keys = {constant, keyframes};
  for (Key& key : window_keys(&ForceSettings::from, &ForceSettings::until, "time when it begins to act",
                              "time when it ends, after `from`", "for ever"))
    keys.push_back(key);
  return keys;
}

schema::Declaration body_key(const char* otherwise, const char* meaning) {
  return schema::text("body", &ForceSettings::body)
      .otherwise(otherwise)
      .means(meaning)
      .shown_as<ForceSettings>([](const ForceSettings& force) {
        return force.body.empty() ? schema::null() : schema::words(force.body);
      });
}

schema::Table type_table(Type type, std::vector<Key> first, std::vector<Key> value, std::vector<Key> last) {
  first.insert(first.end(), value.begin(), value.end());
  first.insert(first.end(), last.begin(), last.end());
  return schema::table_of<ForceSettings>(name_of(force_type_names(), type), std::move(first));
}

const schema::Table& gravity_table() {
  static const schema::Table table =
      type_table(Type::gravity, {body_key("every body", "the body it acts on")},
                 value_keys<Type::gravity>("the same for everything it acts on"), {});
  return table;
}

const schema::Table& point_table() {
  static const schema::Table table = type_table(
      Type::point,
      {body_key("the only body", "a body, or a collider with a density; must be given if there are several"),
       schema::nested("where", &ForceSettings::where, selection_table)
           .otherwise("must be given")
           .means("selection of vertices; for a collider with a density those of its mesh, or, without "
                  "`where`, its "
                  "centre of mass")},
      value_keys<Type::point>("on each of the chosen vertices"), {});
  return table;
}

const schema::Table& wind_table() {
  static const schema::Table table = [] {
    Key lift = schema::number("lift", &ForceSettings::lift)
                   .range({0, 1e3, false})
                   .means("lift coefficient, at most `drag`");
    lift.read = [](const Key& key, const TomlTable& table, void* s) {
      auto& force = *static_cast<ForceSettings*>(s);
      force.lift = table.number(key.name, key.unit, {0, force.drag, false});
    };
    schema::Table wind = type_table(Type::wind, {body_key("every body", "the body it acts on")},
                                    value_keys<Type::wind>("the mean velocity of the air"),
                                    {schema::number("air_density", &ForceSettings::air_density)
                                         .unit("kg/m³")
                                         .range({0, 1e5, false})
                                         .means("density of the air"),
                                     schema::number("drag", &ForceSettings::drag)
                                         .range({0, 1e3, false})
                                         .means("drag coefficient; 1.17 is a square plate, broadside"),
                                     lift,
                                     schema::number("gust", &ForceSettings::gust)
                                         .unit("m/s")
                                         .range({0, 1e4, false})
                                         .means("root mean square of each component of the turbulence"),
                                     schema::number("gust_length", &ForceSettings::gust_length)
                                         .unit("m")
                                         .range({1e-6, 1e6, false})
                                         .means("size of its largest eddies"),
                                     schema::whole_number("seed", &ForceSettings::seed)
                                         .range(Range::non_negative())
                                         .means("whole number that seeds the turbulence")});
    schema::add_rule<ForceSettings>(wind, [](const ForceSettings& force, const schema::Subject& subject) {
      if (force.lift > force.drag)
        throw subject.error("lift", fmt::format("`lift` = {} is above `drag` = {}", force.lift, force.drag),
                            "lower it, or raise `drag`");
    });
    return wind;
  }();
  return table;
}

schema::Table declared() {
  schema::Table table = schema::table_of<ForceSettings>(
      "[[force]]", {name_key<ForceSettings>("`gravity0`, `point1`, …").means("name in messages"),
                    schema::word("type", &ForceSettings::type, force_type_names())
                        .required()
                        .means("`\"gravity\"`, `\"point\"` or `\"wind\"`")});
  schema::choose(table, "type", &ForceSettings::type,
                 {{"gravity", "", gravity_table}, {"point", "", point_table}, {"wind", "", wind_table}});
  schema::add_rule<ForceSettings>(table, [](const ForceSettings& force, const schema::Subject& subject) {
    check_window(force.from, force.until, subject);
    if (subject.table() == nullptr && force.value.keys.empty())
      throw subject.error("", "it has no value", "give at least one key");
  });
  return table;
}

}  // namespace

const schema::Table& force_table() {
  static const schema::Table table = declared();
  return table;
}

void finish_force(const TomlTable& table, std::size_t index, ForceSettings& force, const Scene& scene) {
  const bool point = force.type == Type::point;
  complete_name(table, fmt::format("{}{}", name_of(force_type_names(), force.type), index), force.name);
  resolve_body(table, scene, !point, force.body);
  if (force.value.keys.empty()) force.value.keys.push_back({0, standard_gravity});
  const bool rigid = is_rigid(scene, force.body);
  if (point && !rigid && !table.has("where")) refuse_without_selection(table);
  if (force.type == Type::wind && rigid)
    throw table.error("body", "wind does not blow on rigid bodies", "push it by a point force");
  require_new_name(table, scene.forces, "force", "force", force.name);
}

}  // namespace muslin
