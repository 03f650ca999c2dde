#include "muslin/scene/vocabulary.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "muslin/material/material_table.hpp"
#include "muslin/material/shell_material.hpp"

namespace muslin {
namespace {

constexpr std::array<std::string_view, 4> reserved_keys = {"collider", "contact", "friction", "self_contact"};

std::vector<std::string> joined(std::vector<std::string> keys, const std::vector<std::string>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

}  // namespace

const std::vector<VocabularyTable>& scene_vocabulary() {
  static const std::vector<VocabularyTable> tables = {
      {"", {"title", "time", "solver", "body", "pin", "force", "probe"}},
      {"time", {"duration", "frame_rate", "steps_per_frame"}},
      {"solver", {"integrator", "tolerance", "max_iterations", "linear_tolerance"}},
      {"body",
       {"name", "mesh", "model", "thickness", "voxel_width", "voxels", "threshold", "bracing", "mass",
        "boundary_springs", "rest_mesh", "warp", "material", "translate", "rotate", "scale", "velocity",
        "colour"}},
      {"body.material", joined({"base", "youngs_modulus", "shear_modulus"}, material_keys())},
      {"body.material of a shell", joined({"base"}, shell_material_keys())},
      {"where", {"group", "box", "sphere", "plane", "line", "nearest"}},
      {"where.sphere", {"center", "radius"}},
      {"where.plane", {"point", "normal", "distance"}},
      {"where.line", {"from", "to", "distance"}},
      {"pin", {"name", "body", "where", "from", "until", "keyframes", "pivot", "sequence"}},
      {"pin.keyframes", {"time", "translate", "rotate"}},
      {"force.gravity", {"type", "name", "body", "acceleration", "keyframes", "from", "until"}},
      {"force.point", {"type", "name", "body", "where", "force", "keyframes", "from", "until"}},
      {"force.wind",
       {"type", "name", "body", "velocity", "keyframes", "from", "until", "air_density", "drag", "lift",
        "gust", "gust_length", "seed"}},
      {"force.keyframes", {"time", "value"}},
      {"probe", {"name", "body", "at"}},
  };
  return tables;
}

const std::vector<std::string>& known_keys(std::string_view table) {
  const auto& tables = scene_vocabulary();
  const auto at = std::find_if(tables.begin(), tables.end(), [&](const auto& t) { return t.name == table; });
  assert(at != tables.end());
  return at->keys;
}

void refuse_reserved_keys(const TomlValue& value) {
  for (std::size_t i = 0; i < value.keys.size(); ++i) {
    if (std::find(reserved_keys.begin(), reserved_keys.end(), value.keys[i]) == reserved_keys.end()) continue;
    throw Error(ErrorKind::input, value.items[i].key_place,
                "`" + value.keys[i] + "` is not available yet in this version", "take it out of the scene");
  }
}

}  // namespace muslin
