// libFuzzer target: any bytes as a scene file, and as a material file. The first line is a setting of the
// command line if it begins with '!'.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/material/material.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/scene/scene_table.hpp"
#include "muslin/scene/validate.hpp"
#include "muslin/schema/value.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> settings;
  if (text.starts_with('!')) {
    const std::size_t end = text.find('\n');
    settings.push_back(text.substr(1, end == std::string::npos ? end : end - 1));
    text.erase(0, end == std::string::npos ? text.size() : end + 1);
  }
  muslin::schema::may_change_on_resume(muslin::scene_table(), text);  // any path
  try {
    muslin::lattice_numbers(muslin::parse_material(text, "material.toml"));
  } catch (const muslin::Error&) {
  }
  muslin::Scene scene;
  try {
    scene = muslin::parse_scene(text, "scene.toml", settings);
  } catch (const muslin::Error&) {
    return 0;  // an Error is a right answer
  }
  muslin::validate(scene);  // accepts what the reader accepts
  const muslin::TomlValue written = muslin::scene_table().write(scene);
  if (scene.resolved != muslin::schema::to_json(written)) __builtin_trap();
  return 0;
}
