#include "muslin/scene/scene.hpp"

#include <cmath>

namespace muslin {

int TimeSettings::frames() const {
  // The last frame ends no earlier than the duration; products like 2.1·10 carry rounding.
  return static_cast<int>(std::ceil(duration * frame_rate * (1 - 1e-12) - 1e-9));
}

std::filesystem::path resolve_path(const Scene& scene, const std::string& path) {
  return SceneFiles{scene.file, scene.meshes}.resolve(path);
}

MeshFile scene_mesh(const Scene& scene, const std::string& path) {
  return SceneFiles{scene.file, scene.meshes}.mesh(path);
}

}  // namespace muslin
