// libFuzzer target: any bytes as a scene file. The first line is a setting of the command line if it begins
// with '!'.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/scene/validate.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> settings;
  if (text.starts_with('!')) {
    const std::size_t end = text.find('\n');
    settings.push_back(text.substr(1, end == std::string::npos ? end : end - 1));
    text.erase(0, end == std::string::npos ? text.size() : end + 1);
  }
  muslin::Scene scene;
  try {
    scene = muslin::parse_scene(text, "scene.toml", settings);
  } catch (const muslin::Error&) {
    return 0;  // an Error is a right answer
  }
  muslin::validate(scene);  // accepts what the reader accepts
  return 0;
}
