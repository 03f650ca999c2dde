#include "muslin/schema/variation_table.hpp"

#include <string>
#include <vector>

#include "muslin/schema/declare.hpp"
#include "muslin/schema/keyframe_keys.hpp"

namespace muslin::schema {
namespace {

constexpr int most_points = 100;  // of a curve

/// A curve of shares over weights, anywhere in the unit square.
struct ShareCurveCodec {
  using Curve = std::vector<Vec2>;

  std::vector<Type> types() const { return {Type::curve}; }
  Range range() const { return Range::between(0, 1); }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    Curve curve;
    for (const TomlValue& item : *table.array(key.name, described(key))) {
      if (item.type != TomlValue::Type::array || item.items.size() != 2)
        throw table.error(key.name, fmt::format("a point of `{}` is no pair of numbers", key.name),
                          fmt::format("give {}", described(key)));
      const std::string name = fmt::format("a number of `{}`", key.name);
      curve.emplace_back(to_number(item.items[0], name, "", key.range),
                         to_number(item.items[1], name, "", key.range));
    }
    if (curve.empty())
      throw table.error(key.name, fmt::format("`{}` has no point", key.name),
                        fmt::format("give {}", described(key)));
    check(key, curve, Subject(table));
    return curve;
  }
  TomlValue write(const Key& key, const Curve& curve) const { return CurveCodec{}.write(key, curve); }
  void check(const Key& key, const Curve& curve, const Subject& subject) const {
    if (curve.size() > key.count)
      throw subject.error(key.name, fmt::format("`{}` has {} points", key.name, curve.size()),
                          fmt::format("give {} at most", key.count));
    double before = -1;
    for (const Vec2& point : curve) {
      if (!fits(point[0], key.range) || !fits(point[1], key.range) || !(point[0] > before))
        throw subject.error(key.name,
                            fmt::format("`{}` has the point [{}, {}]", key.name, point[0], point[1]),
                            "give numbers from 0 to 1, the first of each point greater than that before");
      before = point[0];
    }
  }
};

/// The forms of a key besides a number, for messages: " or a map".
std::string other_forms(const Key& key) {
  return std::string(key.forms.map ? " or a map" : "") + (key.forms.keyframes ? " or keyframes" : "");
}

}  // namespace

const Table& variation_table() {
  static const Table table = [] {
    const auto has_map = [](const Variation& v) { return v.is_map(); };
    Key curve = stored("curve", &Variation::curve, ShareCurveCodec{});
    curve.count = most_points;
    Table variation = table_of<Variation>(
        "a number that varies",
        {text("map", &Variation::map)
             .required_without({"keyframes"})
             .excludes("keyframes", "a number varies by a map or in time, not both")
             .shown_if<Variation>(has_map)
             .means("where it varies: an attribute or group of the mesh, or a file of numbers"),
         number("from", &Variation::from)
             .required_without({"keyframes"})
             .needs("map", "name the map")
             .shown_if<Variation>(has_map)
             .means("the number where the map has its `lowest` value"),
         number("to", &Variation::to)
             .required_without({"keyframes"})
             .needs("map", "name the map")
             .shown_if<Variation>(has_map)
             .means("the number where the map has its `highest` value"),
         number("lowest", &Variation::lowest)
             .needs("map", "name the map")
             .shown_if<Variation>(has_map)
             .means("value of the map that stands for `from`"),
         number("highest", &Variation::highest)
             .needs("map", "name the map")
             .shown_if<Variation>(has_map)
             .means("value of the map that stands for `to`"),
         Declaration(curve)
             .needs("map", "name the map")
             .shown_if<Variation>([](const Variation& v) { return !v.curve.empty(); })
             .otherwise("a straight line")
             .means("points `[[weight, share], …]` between 0 and 1: the number goes from `from` to `to` by "
                    "the share"),
         keyframes("keyframes", &Variation::keyframes, number_keyframe_table)
             .shown_if<Variation>([](const Variation& v) { return !v.is_map(); })
             .otherwise("none")
             .means("when it varies: constant before the first and after the last")});
    add_rule<Variation>(variation, [](const Variation& v, const Subject& subject) {
      if (!v.is_map() && v.keyframes.empty())
        throw subject.error("map", "a number that varies names no map and has no keyframes", "give one");
      if (!(v.highest > v.lowest))
        throw subject.error("highest", fmt::format("`highest` = {} is not above {}", v.highest, v.lowest),
                            "give the values of the map that stand for `from` and `to`");
    });
    return variation;
  }();
  return table;
}

Variation read_variation(const Key& key, const TomlTable& table) {
  const TomlTable own =
      variation_table().open(*table.find(key.name), fmt::format("`{}` of {}", key.name, table.title()));
  Variation variation;
  variation_table().read(own, variation);
  variation.key = key.name;
  check_variation(key, variation, Subject(table));
  return variation;
}

void check_variation(const Key& key, const Variation& variation, const Subject& subject) {
  variation_table().check(variation, subject);
  if (variation.is_map() ? !key.forms.map : !key.forms.keyframes)
    throw subject.error(
        key.name,
        fmt::format("`{}` cannot vary {}", key.name, variation.is_map() ? "by a map" : "by keyframes"),
        fmt::format("give {}{}", described(key), other_forms(key)));
  const auto check = [&](const std::string& which, double x) {
    if (!fits(x, key.range))
      throw subject.error(key.name, fmt::format("`{}` is {} {}", key.name, x, which),
                          fmt::format("give {}", described(key)));
  };
  if (variation.is_map()) {
    check("at the `from` of its map", variation.from);
    check("at the `to` of its map", variation.to);
  }
  for (const NumberKeyframe& keyframe : variation.keyframes)
    check(fmt::format("at {} s", keyframe.time), keyframe.value);
}

}  // namespace muslin::schema
