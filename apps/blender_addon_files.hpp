// The add-on for Blender, compiled in (cmake/blender.cmake).
#pragma once

#include <span>
#include <string_view>

namespace muslin::app {

struct AddonFile {
  std::string_view name, text;
};

/// All but scene_schema.json and the program.
std::span<const AddonFile> blender_addon_files();

}  // namespace muslin::app
