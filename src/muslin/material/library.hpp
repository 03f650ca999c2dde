// Provides the texts of materials/*.toml, compiled into the library when it is configured.
#pragma once

#include <span>
#include <string_view>

namespace muslin {

struct LibraryMaterial {
  std::string_view name;  ///< the file's name without its suffix
  std::string_view text;
};

/// Returns all materials in alphabetical order.
std::span<const LibraryMaterial> material_library();

}  // namespace muslin
