#include "muslin/scene/selection_table.hpp"

#include "muslin/core/nearest_name.hpp"
#include "muslin/scene/points_key.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {
namespace {

using schema::Key;
using schema::Type;

/// One point, or a list of points.
void read_nearest(const Key& key, const TomlTable& where, Selection& selection) {
  const auto& items = *where.array(key.name, "points, [x, y, z] or [[x, y, z], …]");
  if (items.empty()) throw where.error(key.name, "`nearest` has no point", "give [x, y, z]");
  selection.nearest.clear();
  if (items.front().type != TomlValue::Type::array) {
    selection.nearest = {to_vector(*where.find(key.name), "`nearest`", key.unit)};
    return;
  }
  for (const TomlValue& item : items)
    selection.nearest.push_back(to_vector(item, "a point of `nearest`", key.unit));
}

const schema::Table& inside_sphere_table() {
  static const schema::Table table = sphere_keys<Selection::SphereShape>("`where.sphere`");
  return table;
}

const schema::Table& near_plane_table() {
  using Plane = Selection::PlaneShape;
  static const schema::Table table = schema::table_of<Plane>(
      "`where.plane`",
      {schema::vector("point", &Plane::point).unit("m").required().means("a point of the plane"),
       schema::direction("normal", &Plane::normal, "[1, 0, 0]").required().means("normal of the plane"),
       schema::number("distance", &Plane::distance)
           .unit("m")
           .range(Range::non_negative())
           .otherwise("half a voxel width")
           .means("greatest distance of a selected vertex")});
  return table;
}

const schema::Table& line_table() {
  using Line = Selection::LineShape;
  static const schema::Table table = [] {
    schema::Table line = schema::table_of<Line>(
        "`where.line`", {schema::vector("from", &Line::a).unit("m").required().means("one end"),
                         schema::vector("to", &Line::b).unit("m").required().means("the other end"),
                         schema::number("distance", &Line::distance)
                             .unit("m")
                             .range(Range::non_negative())
                             .otherwise("¾ of a voxel width")
                             .means("greatest distance of a selected vertex")});
    schema::add_rule<Line>(line, [](const Line& settings, const schema::Subject& subject) {
      if (settings.a == settings.b)
        throw subject.error("to", "the line ends where it begins", "use `nearest` for a point");
    });
    return line;
  }();
  return table;
}

schema::Table declare_selection() {
  schema::Table table = schema::table_of<Selection>(
      "`where`",
      {schema::text("group", &Selection::group)
           .means("carries a vertex or face of this group of the mesh (OBJ `g`)"),
       box_key(&Selection::box)
           .means(
               "lies in the box between two corners `[[x, y, z], [x, y, z]]`, the smaller coordinates first"),
       schema::nested("sphere", &Selection::sphere, inside_sphere_table)
           .means("lies within `radius` of `center`"),
       schema::nested("plane", &Selection::plane, near_plane_table)
           .means("lies within `distance` of the plane through `point` across `normal`"),
       schema::nested("line", &Selection::line, line_table)
           .means("lies within `distance` of the segment `from` – `to`"),
       schema::custom<Selection>("nearest", {Type::vector, Type::points}, read_nearest,
                                 [](const Key& key, const Selection& s, TomlValue& out) {
                                   if (!s.nearest.empty()) write_points(key, s.nearest, out);
                                 })
           .unit("m")
           .means("is the nearest to a point, or one of several that are equally near, among those which "
                  "satisfy "
                  "the other criteria; one point or a list of points")});
  schema::add_rule<Selection>(table, [](const Selection&, const schema::Subject& subject) {
    if (subject.table() != nullptr && subject.table()->size() == 0)
      throw subject.error("", "`where` is empty",
                          "give one or more of " + name_list(selection_table().names()));
  });
  return table;
}

}  // namespace

const schema::Table& selection_table() {
  static const schema::Table table = declare_selection();
  return table;
}

void refuse_without_selection(const TomlTable& owner) {
  throw owner.error("where", owner.title() + " has no `where`",
                    "give one or more of " + name_list(selection_table().names()));
}

}  // namespace muslin
