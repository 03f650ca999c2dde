#include "muslin/scene/read_selection.hpp"

#include "muslin/core/nearest_name.hpp"
#include "muslin/scene/read_parts.hpp"
#include "muslin/scene/vocabulary.hpp"

namespace muslin {
namespace {

std::optional<double> optional_distance(const TomlTable& table) {
  if (!table.has("distance")) return std::nullopt;
  return table.number("distance", "m", Range::non_negative());
}

Selection::BoxShape read_box(const TomlTable& where) {
  const auto& corners = *where.array("box", "two corners, [[x, y, z], [x, y, z]]");
  if (corners.size() != 2) {
    throw where.error("box", "`box` is a list of " + std::to_string(corners.size()),
                      "give its two corners, [[x, y, z], [x, y, z]]");
  }
  const Selection::BoxShape box{to_vector(corners[0], "the first corner of `box`", "m"),
                                to_vector(corners[1], "the second corner of `box`", "m")};
  if ((box.min.array() > box.max.array()).any()) {
    throw where.error("box", "the first corner of `box` is not below the second along every axis",
                      "give the corner of the smallest coordinates first");
  }
  return box;
}

Selection::PlaneShape read_plane(const TomlTable& table) {
  return {table.vector("point", "m"), read_direction(table, "normal", "[1, 0, 0]"), optional_distance(table)};
}

Selection::LineShape read_line(const TomlTable& table) {
  const Selection::LineShape line{table.vector("from", "m"), table.vector("to", "m"),
                                  optional_distance(table)};
  if (line.a == line.b) throw table.error("to", "the line ends where it begins", "use `nearest` for a point");
  return line;
}

/// One point, or a list of points.
std::vector<Vec3> read_points(const TomlTable& where) {
  const auto& items = *where.array("nearest", "points, [x, y, z] or [[x, y, z], …]");
  if (items.empty()) throw where.error("nearest", "`nearest` has no point", "give [x, y, z]");
  if (items.front().type != TomlValue::Type::array) {
    return {to_vector(*where.find("nearest"), "`nearest`", "m")};
  }
  std::vector<Vec3> points;
  for (const TomlValue& item : items) points.push_back(to_vector(item, "a point of `nearest`", "m"));
  return points;
}

}  // namespace

Selection read_selection(const TomlTable& owner) {
  const auto where = owner.table("where", known_keys("where"));
  const std::string criteria = "give one or more of " + name_list(known_keys("where"));
  if (!where) throw owner.error("where", owner.title() + " has no `where`", criteria);
  if (where->size() == 0) throw owner.error("where", "`where` is empty", criteria);
  Selection selection;
  selection.place = where->place();
  if (where->has("group")) selection.group = where->string("group");
  if (where->has("box")) selection.box = read_box(*where);
  if (const auto sphere = where->table("sphere", known_keys("where.sphere"))) {
    selection.sphere = {sphere->vector("center", "m"), sphere->number("radius", "m", Range::positive())};
  }
  if (const auto plane = where->table("plane", known_keys("where.plane"))) {
    selection.plane = read_plane(*plane);
  }
  if (const auto line = where->table("line", known_keys("where.line"))) selection.line = read_line(*line);
  if (where->has("nearest")) selection.nearest = read_points(*where);
  return selection;
}

}  // namespace muslin
