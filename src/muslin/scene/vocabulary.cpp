#include "muslin/scene/vocabulary.hpp"

#include <algorithm>
#include <cassert>

#include "muslin/material/material_table.hpp"
#include "muslin/material/shell_material.hpp"

namespace muslin {
namespace {

std::vector<std::string> joined(std::vector<std::string> keys, const std::vector<std::string>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

std::vector<std::string> collider_keys(const std::vector<std::string>& more) {
  return joined({"shape", "name", "keyframes", "contact", "friction", "colour"}, more);
}

/// Returns the keys of colliders that rotate and may have mass: all but the plane.
std::vector<std::string> moving_keys(const std::vector<std::string>& more) {
  return joined(collider_keys({"pivot", "density", "velocity", "angular_velocity"}), more);
}

}  // namespace

const std::vector<VocabularyTable>& scene_vocabulary() {
  static const std::vector<VocabularyTable> tables = {
      {"", {"title", "time", "solver", "body", "collider", "contact", "pin", "force", "probe"}},
      {"time", {"duration", "frame_rate", "steps_per_frame"}},
      {"solver", {"integrator", "effort", "tolerance", "linear_tolerance"}},
      {"body", {"name",      "mesh",         "model",    "thickness",    "voxel_width",
                "voxels",    "threshold",    "bracing",  "mass",         "boundary_springs",
                "rest_mesh", "warp",         "material", "translate",    "rotate",
                "scale",     "velocity",     "contact",  "self_contact", "friction",
                "colour",    "stretch_limit"}},
      {"body.material", joined({"base", "youngs_modulus", "shear_modulus"}, material_keys())},
      {"body.material of a shell", joined({"base"}, shell_material_keys())},
      {"collider.plane", collider_keys({"center", "normal", "pivot"})},
      {"collider.sphere", moving_keys({"center", "radius"})},
      {"collider.capsule", moving_keys({"points", "radius"})},
      {"collider.box", moving_keys({"center", "size", "rotate"})},
      {"collider.mesh",
       moving_keys({"mesh", "translate", "rotate", "scale", "sequence", "frame_rate", "start"})},
      {"collider.keyframes", {"time", "translate", "rotate"}},
      {"contact", {"distance", "friction"}},
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

}  // namespace muslin
