#include "muslin/scene/point_force.hpp"

#include <memory>
#include <utility>

#include "muslin/force/point_force.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/selection_table.hpp"

namespace muslin {
namespace {

const schema::Table& keyframes() {
  static const schema::Table table = force_keyframe_table("point", "force", "N");
  return table;
}

const schema::Table& keys() {
  static const schema::Table table = [] {
    schema::Table point = schema::table_of<ForceSettings>(
        "point",
        {force_body_key("the only body",
                        "a body, or a collider with a density; must be given if there are several"),
         schema::nested("where", &ForceSettings::where, selection_table)
             .otherwise("must be given")
             .means("selection of vertices; for a collider with a density those of its mesh, or, without "
                    "`where`, its "
                    "centre of mass")});
    add_value_keys(
        point,
        {.key = "force", .unit = "N", .meaning = "force on each selected vertex", .keyframes = keyframes});
    return point;
  }();
  return table;
}

void check(const ForceSettings& force, const Scene& scene, const schema::Subject& subject) {
  if (force.where || is_rigid(scene, force.body)) return;
  if (subject.table() != nullptr) refuse_without_selection(*subject.table());
  throw subject.error("where", "a point force has no `where`", "select the vertices it acts on");
}

void add(Model& model, const ForceSettings& force) {
  const Component& body = model.body(force.body);
  LoadedVertices loaded = body.loaded_vertices(force.where, "force " + force.name);
  for (int& v : loaded.vertices) v += body.first_vertex;
  model.loads.push_back(
      {force.name, EnergyRole::work,
       std::make_shared<PointForce>(std::move(loaded.vertices), force.value, Window{force.from, force.until},
                                    std::move(loaded.shares))});
}

}  // namespace

const ForceKind point_kind = {.name = "point", .keys = keys, .on_one_body = true, .check = check, .add = add};

}  // namespace muslin
