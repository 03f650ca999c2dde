#include "muslin/scene/scene.hpp"

#include <cmath>

namespace muslin {

int TimeSettings::frames() const {
  // The last frame ends no earlier than the duration; products like 2.1·10 carry rounding.
  return static_cast<int>(std::ceil(duration * frame_rate * (1 - 1e-12) - 1e-9));
}

std::filesystem::path resolve_path(const Scene& scene, const std::string& path) {
  return scene.file.parent_path() / path;
}

MeshFile scene_mesh(const Scene& scene, const std::string& path) {
  const auto own = scene.meshes.find(path);
  return own != scene.meshes.end() ? MeshFile{*own->second, ""} : read_mesh(resolve_path(scene, path));
}

}  // namespace muslin
