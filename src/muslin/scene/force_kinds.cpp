#include "muslin/scene/force_kinds.hpp"

#include <algorithm>
#include <utility>

#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/field_force.hpp"
#include "muslin/scene/gravity_force.hpp"
#include "muslin/scene/point_force.hpp"
#include "muslin/scene/wind_force.hpp"

namespace muslin {
namespace {

schema::Table declare_force() {
  std::vector<std::string> types, quoted;
  std::vector<schema::Variant> variants;
  for (const ForceKind& kind : force_kinds()) {
    types.emplace_back(kind.name);
    quoted.push_back(fmt::format("`\"{}\"`", kind.name));
    variants.push_back({kind.name, "", kind.keys});
  }
  const std::string last = std::exchange(quoted.back(), "");
  quoted.pop_back();
  schema::Table table = schema::table_of<ForceSettings>(
      "[[force]]", {name_key<ForceSettings>("`gravity0`, `point1`, …").means("name in messages"),
                    schema::word("type", &ForceSettings::type, types)
                        .required()
                        .means(fmt::format("{} or {}", fmt::join(quoted, ", "), last))});
  schema::choose(table, "type", &ForceSettings::type, std::move(variants));
  schema::add_rule<ForceSettings>(table, [](const ForceSettings& force, const schema::Subject& subject) {
    check_window(force.from, force.until, subject);
  });
  return table;
}

}  // namespace

const std::vector<ForceKind>& force_kinds() {
  static const std::vector<ForceKind> kinds = [] {
    std::vector<ForceKind> all = {gravity_kind, point_kind, wind_kind};
    all.insert(all.end(), field_kinds().begin(), field_kinds().end());
    return all;
  }();
  return kinds;
}

const ForceKind& kind_of(const ForceSettings& force) {
  const auto kind = std::find_if(force_kinds().begin(), force_kinds().end(),
                                 [&](const ForceKind& each) { return each.name == force.type; });
  require(kind != force_kinds().end(), "the type of a force is no kind of force",
          "use one that `type` of a scene file has");
  return *kind;
}

const schema::Table& force_table() {
  static const schema::Table table = declare_force();
  return table;
}

void finish_force(const TomlTable& table, std::size_t index, ForceSettings& force, const Scene& scene) {
  const ForceKind& kind = kind_of(force);
  complete_name(table, fmt::format("{}{}", kind.name, index), force.name);
  resolve_body(table, scene, !kind.on_one_body, force.body);
  if (kind.check != nullptr) kind.check(force, scene, schema::Subject(table));
  require_new_name(table, scene.forces, "force", "force", force.name);
}

void build_forces(Model& model) {
  for (const ForceSettings& force : model.scene.forces) kind_of(force).add(model, force);
}

}  // namespace muslin
