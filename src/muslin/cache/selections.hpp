// Reads and writes selections.json: the vertices of the pins and point forces of a run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// The points that a `where` of the scene selected, numbered as in RunReader::selectable_points: in the cache
/// of the body's vertices, or else of its skin.
struct Chosen {
  std::string name;
  int body = 0;
  std::vector<int> vertices;   ///< ascending
  double from = 0, until = 0;  ///< [s] of a pin: when it holds; `until` may be infinite
  int force = -1;              ///< of a point force: its index among the forces of the resolved scene
};

struct Selections {
  std::vector<Chosen> pins, point_forces;
};

MUSLIN_API Selections selections_of(const Model& model);
MUSLIN_API std::string selections_json(const Model& model);

/// `points`: the number of points in the cache of each body. Empty if the file does not exist: versions
/// before 0.1 did not write it. Errors: file; input, if it is damaged.
MUSLIN_API Selections read_selections(const std::filesystem::path& path,
                                      const std::vector<std::string>& bodies,
                                      const std::vector<std::size_t>& points);

}  // namespace muslin
