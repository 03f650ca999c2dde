#include "muslin/scene/pin_table.hpp"

#include <algorithm>

#include "muslin/core/nearest_name.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/selection_table.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

std::string both_move(const char* key) {
  return fmt::format("`{}` and `sequence` both say how the pin moves", key);
}

std::vector<schema::Key> softness_keys() {
  return {schema::number("stiffness", &PinSettings::stiffness)
              .unit("N/m")
              .range({0, 1e9, true})
              .otherwise("the pin holds exactly")
              .means("of the whole pin, which is then soft: springs pull its vertices to their targets; each "
                     "has a share by its mass"),
          schema::number("time", &PinSettings::time)
              .unit("s")
              .range({1e-3, 1e6, false})
              .excludes("stiffness", "`time` and `stiffness` both say how hard the pin pulls")
              .excludes("damping", "`time` and `damping` both say how the pin is damped")
              .means("in place of `stiffness`: time in which a critically damped soft pin brings its body to "
                     "the target"),
          schema::number("damping", &PinSettings::damping)
              .unit("N·s/m")
              .range({0, 1e9, false})
              .shown_if<PinSettings>([](const PinSettings& pin) { return pin.stiffness.has_value(); })
              .needs("stiffness", "only a soft pin is damped: give its `stiffness`")
              .means("of the whole pin, against motion relative to the target"),
          schema::number("weight", &PinSettings::weight)
              .range(Range::between(0, 1))
              .varies(&PinSettings::variations, {.map = true, .keyframes = true})
              .shown_if<PinSettings>([](const PinSettings& pin) { return pin.is_soft(); })
              .means("of a soft pin at each vertex, as a factor of stiffness and damping; where it is 0 the "
                     "vertex is free")};
}

schema::Table declare_pin() {
  schema::Table table = schema::table_of<PinSettings>(
      "[[pin]]",
      {name_key<PinSettings>("`pin0`, `pin1`, …").means("name in messages and in `selections.json`"),
       schema::text("body", &PinSettings::body)
           .otherwise("the only body")
           .means("a body, or a collider with a density; must be given if there are several"),
       schema::nested("where", &PinSettings::where, selection_table)
           .otherwise("must be given")
           .means("selection of vertices; a collider with a density is held as a whole, without `where`")});
  for (schema::Key& key : window_keys(&PinSettings::from, &PinSettings::until,
                                      "start time; the vertices are held at their positions at that time",
                                      "release time, after `from`", "never"))
    table.keys.push_back(key);
  for (schema::Key& key : softness_keys()) table.keys.push_back(std::move(key));
  table.keys.push_back(schema::vector("pivot", &PinSettings::pivot)
                           .unit("m")
                           .otherwise("centre of its vertices at rest")
                           .excludes("sequence", both_move("pivot"))
                           .means("point about which `rotate` turns and `scale` scales"));
  table.keys.push_back(
      schema::path("sequence", &PinSettings::sequence, &PinSettings::sequence_place)
          .means("motion, in place of `keyframes`: a file with the position of every vertex of the body's "
                 "mesh per "
                 "frame: `.pc2`, `.mdd`, or numbered files `walk.####.obj`. Metres, y up, in the world"));
  table.keys.push_back(schema::within<PinSettings>(&PinSettings::motion,
                                                   motion_key()
                                                       .excludes("sequence", both_move("keyframes"))
                                                       .means("motion: a list of tables; times ascend")));
  table.keys.push_back(schema::texts("ignore", &PinSettings::ignore)
                           .otherwise("none")
                           .shown_if<PinSettings>([](const PinSettings& pin) { return !pin.ignore.empty(); })
                           .means("bodies and colliders that the held vertices, with the edges and triangles "
                                  "at them, pass through while the pin holds"));
  schema::add_rule<PinSettings>(table, [](const PinSettings& pin, const schema::Subject& subject) {
    check_window(pin.from, pin.until, subject);
    if (!pin.is_soft() && (pin.weight != 1 || !pin.variations.empty()))
      throw subject.error("weight", "only a soft pin has a weight", "give its `stiffness` or `time`");
  });
  return table;
}

}  // namespace

const schema::Table& pin_table() {
  static const schema::Table table = declare_pin();
  return table;
}

void finish_pin(const TomlTable& table, std::size_t index, PinSettings& pin, const Scene& scene) {
  complete_name(table, fmt::format("pin{}", index), pin.name);
  resolve_body(table, scene, false, pin.body);
  if (!is_rigid(scene, pin.body)) {
    if (!table.has("where")) refuse_without_selection(table);
  } else if (table.has("where")) {
    throw table.error("where", "a rigid body is held as a whole", "take `where` out");
  } else if (!pin.variations.empty()) {
    throw table.error("weight", "a rigid body is held as a whole, not by a map", "give a number");
  } else if (table.has("sequence")) {
    throw table.error("sequence", "a rigid body does not follow a sequence", "move it by `keyframes`");
  } else if (pin.motion.scales()) {
    throw table.error("keyframes", "a rigid body is not scaled", "take `scale` out");
  }
  const std::vector<std::string> names = all_names(scene);
  for (const std::string& body : pin.ignore) {
    if (std::find(names.begin(), names.end(), body) == names.end())
      throw table.error("ignore", fmt::format("there is no body or collider `{}`", body),
                        name_advice(body, names));
  }
  require_new_name(table, scene.pins, "pin", "pin", pin.name);
}

}  // namespace muslin
