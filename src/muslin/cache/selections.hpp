// Reads and writes selections.json: the vertices of the pins and point forces of a run, and its cords.
#pragma once

#include <array>
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

/// A joint of an attachment whose points may be apart: a cord or a rod.
struct Cord {
  struct End {
    int body = 0;
    std::array<int, 3> points{};  ///< of the skin in its cache: corners of the triangle nearest to the joint
    Vec3 weights = Vec3::Zero();  ///< barycentric
  };
  std::string name;            ///< of the attachment
  bool slackens = true;        ///< false: a rod
  double from = 0, until = 0;  ///< [s]; `until` may be infinite
  std::array<End, 2> ends;
};

struct Selections {
  std::vector<Chosen> pins, point_forces;
  std::vector<Cord> cords;
};

MUSLIN_API Selections selections_of(const Model& model);
MUSLIN_API std::string selections_json(const Model& model);

/// `points`, `skins`: the numbers of points in the caches of each body, of its vertices and of its skin.
/// Empty if the file does not exist: versions before 0.1 did not write it. Errors: file; input, if it is
/// damaged.
MUSLIN_API Selections read_selections(const std::filesystem::path& path,
                                      const std::vector<std::string>& bodies,
                                      const std::vector<std::size_t>& points,
                                      const std::vector<std::size_t>& skins);

}  // namespace muslin
