#include "muslin/core/toml_table.hpp"
#include "muslin/scene/common_keys.hpp"
#include "muslin/scene/overrides.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/scene/scene_table.hpp"
#include "muslin/schema/value.hpp"

namespace muslin {
namespace {

/// Refuses `contact.mode`, a key of earlier versions.
void refuse_mode(const TomlTable& top) {
  const TomlValue* contact = top.find("contact");
  if (contact == nullptr || contact->type != TomlValue::Type::table) return;
  const TomlValue* mode = contact->find("mode");
  if (mode == nullptr) return;
  throw Error(ErrorKind::input, mode->key_place,
              "contact.mode no longer exists: every scene is solved in one way",
              "remove it, and set solver.effort = \"draft\", \"normal\" or \"exact\" if it matters");
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scene(read_text(file), file, overrides);
}

Scene parse_scene(const std::string& text, const std::filesystem::path& file,
                  const std::vector<std::string>& overrides) {
  TomlValue root = parse_toml(text, file.string());
  for (const std::string& setting : overrides) apply_override(root, setting);
  root.place = {file.string(), 0, 0};
  const TomlTable top = scene_table().open(root, "the scene");
  refuse_mode(top);

  Scene scene;
  scene.file = file;
  scene.text = text;
  scene.overrides = overrides;
  scene.title = file.stem().string();
  scene_table().read(top, scene);
  require_movable(scene);
  scene.resolved = schema::to_json(scene_table().write(scene));
  return scene;
}

}  // namespace muslin
