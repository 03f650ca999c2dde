// What a scene or mesh is and what will be built from it: `muslin check` and stats.json.
#pragma once

#include <string>

#include "muslin/geometry/inspect.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// JSON: `title`, `time`, `bodies` (a list, each with `name`, `vertices`, `voxels`, `tetrahedra`,
/// `springs.edge`, `.face_diagonal`, `.body_diagonal`, `mass`, `coverage`, `contour_distance`, …), `pins`,
/// `forces`, `probes`, `warnings`.
std::string describe_json(const Model& model);
/// Its `bodies` alone: stats.json.
std::string statistics_json(const Model& model);
/// The same to read.
std::string describe_text(const Model& model);

/// Of a bare mesh file; `file` is the name to print.
std::string describe_json(const MeshReport& report, const std::string& file);
std::string describe_text(const MeshReport& report, const std::string& file);

}  // namespace muslin
