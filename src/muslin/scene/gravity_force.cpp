#include "muslin/scene/gravity_force.hpp"

#include <memory>

#include "muslin/force/gravity.hpp"

namespace muslin {
namespace {

const Vec3 standard_gravity(0, -9.8, 0);

const schema::Table& keyframes() {
  static const schema::Table table = force_keyframe_table("gravity", "acceleration", "m/s²");
  return table;
}

const schema::Table& keys() {
  static const schema::Table table = [] {
    schema::Table gravity =
        schema::table_of<ForceSettings>("gravity", {force_body_key("every body", "the body it acts on")});
    add_value_keys(gravity, {.key = "acceleration",
                             .unit = "m/s²",
                             .meaning = "acceleration of all bodies it acts on",
                             .keyframes = keyframes,
                             .otherwise = "`[0, -9.8, 0]`"});
    gravity.complete = [](const TomlTable&, void* settings) {
      Keyed& value = static_cast<ForceSettings*>(settings)->value;
      if (value.keys.empty()) value.keys.push_back({0, standard_gravity});
    };
    return gravity;
  }();
  return table;
}

void add(Model& model, const ForceSettings& force) {
  // Only a field constant during the whole run stores energy; a changing one does work.
  const bool steady =
      force.value.keys.size() == 1 && force.from <= 0 && force.until >= model.scene.time.duration;
  model.loads.push_back({force.name, steady ? EnergyRole::potential : EnergyRole::work,
                         std::make_shared<Gravity>(masses_acted_on(model, force), force.value,
                                                   Window{force.from, force.until})});
}

}  // namespace

const ForceKind gravity_kind = {.name = "gravity", .keys = keys, .add = add};

}  // namespace muslin
