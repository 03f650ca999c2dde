#include "muslin/scene/contact_pair.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/nearest_name.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

using Side = ContactPairSettings::Side;

const schema::Table& side_table() {
  static const schema::Table table = schema::table_of<Side>(
      "a side of `between`",
      {schema::text("body", &Side::body).required().means("a body or collider"),
       schema::text("group", &Side::group)
           .otherwise("all of it")
           .means("a group of vertices or faces of its mesh; an edge or triangle belongs to it if any of its "
                  "corners does")});
  return table;
}

void read_between(const schema::Key& key, const TomlTable& table, ContactPairSettings& pair) {
  const std::vector<TomlValue>& items = *table.array(key.name, "two names");
  if (items.size() != pair.between.size())
    throw table.error(key.name, fmt::format("`between` has {} sides", items.size()),
                      "name two, such as [\"cloth\", \"table\"]; twice the same one for a body with itself");
  for (std::size_t i = 0; i < items.size(); ++i) {
    Side& side = pair.between[i];
    if (items[i].type == TomlValue::Type::string) {
      side = {items[i].string, std::nullopt, items[i].place};
    } else {
      side_table().read(side_table().open(items[i], fmt::format("a side of {}", table.title())), side);
    }
  }
}

void write_between(const schema::Key& key, const ContactPairSettings& pair, TomlValue& out) {
  TomlValue sides = schema::list({});
  for (const Side& side : pair.between)
    sides.items.push_back(side.group ? side_table().write(side) : schema::words(side.body));
  schema::append(out, key.name, std::move(sides));
}

schema::Key between_key() {
  schema::Key key =
      schema::custom<ContactPairSettings>("between", {schema::Type::texts}, read_between, write_between)
          .required()
          .means(
              "two bodies or colliders by name, twice the same one for a body with itself; `{ body = …, "
              "group = … }` in place of a name takes only a group of its vertices");
  key.count = 2;
  key.table = side_table;
  return key;
}

schema::Table declare_contact_pair() {
  using Pair = ContactPairSettings;
  schema::Table table = schema::table_of<Pair>(
      "[[contact.pair]]",
      {between_key(),
       schema::truth("contact", &Pair::contact)
           .means("`false`: the two pass through each other · `true`: they meet, though an earlier pair says "
                  "that they do not"),
       schema::number("thickness", &Pair::thickness)
           .unit("m")
           .range({0, 1e6, false})
           .steady(steady_thickness)
           .otherwise("half the thickness of each")
           .means("distance of their midsurfaces when they touch; balls and capsules add their radius"),
       schema::number("distance", &Pair::distance)
           .unit("m")
           .range({1e-9, 1e6, false})
           .steady(steady_distance)
           .otherwise("as without the pair")
           .means("contact distance: they repel each other where the gap is below it"),
       schema::number("friction", &Pair::friction)
           .range({0, 100, false})
           .varies(&Pair::variations, {.keyframes = true})
           .otherwise("that of the two")
           .means("Coulomb's coefficient between them"),
       schema::number("stiffness", &Pair::stiffness)
           .unit("N/m")
           .range({0, 1e12, true})
           .otherwise("by their materials")
           .means("stiffness of a contact between them")});
  for (schema::Key& key : window_keys(&Pair::from, &Pair::until, "time from which the pair is in force",
                                      "time when it ends, after `from`", "no end"))
    table.keys.push_back(key);
  schema::add_rule<Pair>(table, [](const Pair& pair, const schema::Subject& subject) {
    check_window(pair.from, pair.until, subject);
  });
  return table;
}

}  // namespace

const schema::Table& contact_pair_table() {
  static const schema::Table table = declare_contact_pair();
  return table;
}

void check_contact_pairs(const Scene& scene) {
  const std::vector<std::string> names = all_names(scene);
  for (const ContactPairSettings& pair : scene.contact.pairs) {
    for (const Side& side : pair.between) {
      if (std::find(names.begin(), names.end(), side.body) == names.end())
        throw Error(ErrorKind::input, side.place,
                    fmt::format("[[contact.pair]]: there is no body or collider `{}`", side.body),
                    name_advice(side.body, names));
    }
  }
}

}  // namespace muslin
