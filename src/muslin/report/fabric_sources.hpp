// Traces every number of a run's materials to its source.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "muslin/cache/run_reader.hpp"
#include "muslin/material/shell_material.hpp"

namespace muslin {

enum class NumberOrigin {
  library,  ///< a material that comes with muslin
  file,     ///< a material file of the user
  unread,   ///< a material file that cannot be read from the scene's folder, or derived; its guesses are
            ///< unknown
  scene,    ///< written in the scene file
  changed,  ///< not set in the scene file but by --set or by a program
  derived,  ///< follows from other numbers, or a default
};
/// Returns the origin in words, such as "from the scene file".
const char* name_of(NumberOrigin origin);

struct FabricNumber {
  std::string key, unit, meaning;  ///< as in material files
  double value = 0;
  MeasuredCurve curve;  ///< the points of a curve, in place of `value`; else empty
  NumberOrigin origin = NumberOrigin::scene;
  /// True if the material file lists it among its guesses.
  bool guess = false;
};

struct Fabric {
  std::string body, model;
  std::string material;  ///< its name; "inline" for a table without a base
  std::string description;
  std::string source;  ///< of the numbers, as the material file states it; may be empty
  std::vector<FabricNumber> numbers;
};

/// Returns one per body of the scene. Parts that cannot be read, such as a scene of another version, are left
/// out. `scene_text` is scene.toml of the run, a copy of `scene_file`, beside which its material files are.
std::vector<Fabric> trace_fabrics(const RunReader& run, const std::string& scene_text,
                                  const std::filesystem::path& scene_file);

}  // namespace muslin
