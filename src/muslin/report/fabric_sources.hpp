// Traces every number of a run's materials to its source.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "muslin/cache/run_reader.hpp"

namespace muslin {

enum class NumberOrigin {
  library,  ///< a material that comes with muslin
  file,     ///< a material file of the user
  scene,    ///< written in the scene file
  changed,  ///< set otherwise than in the scene file: by --set, or by a program
  derived,  ///< follows from other numbers, or a default
};
/// Returns the origin in words, such as "from the scene file".
const char* name_of(NumberOrigin origin);

struct FabricNumber {
  std::string key, unit, meaning;  ///< as in material files
  double value = 0;
  NumberOrigin origin = NumberOrigin::scene;
  /// True for a guess that its material file marks as one.
  bool estimated = false;
};

struct Fabric {
  std::string body, model;
  std::string material;  ///< its name; "inline" for a table without a base
  std::string description;
  std::string source;  ///< of the material's numbers in its own words; empty: it gives none
  std::vector<FabricNumber> numbers;
};

/// Returns one for each body of the scene. What cannot be read, such as a scene of another version, is left
/// out; `scene_text` is scene.toml of the run.
std::vector<Fabric> trace_fabrics(const RunReader& run, const std::string& scene_text);

}  // namespace muslin
