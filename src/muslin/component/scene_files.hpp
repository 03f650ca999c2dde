// SceneFiles finds the files and meshes that the settings of a scene name.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "muslin/geometry/mesh.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {

struct SceneFiles {
  std::filesystem::path scene;                                ///< of the scene file
  std::map<std::string, std::shared_ptr<const Mesh>> meshes;  ///< in memory; they override files

  /// Returns a path as written in the scene, resolved against the scene file's folder.
  std::filesystem::path resolve(const std::string& path) const { return scene.parent_path() / path; }
  /// Returns the mesh called `path` in the scene. Errors: as read_mesh.
  MeshFile mesh(const std::string& path) const {
    const auto own = meshes.find(path);
    return own != meshes.end() ? MeshFile{*own->second, ""} : read_mesh(resolve(path));
  }
};

}  // namespace muslin
