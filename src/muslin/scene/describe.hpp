// Describes a scene or mesh and the model built from it, for `muslin check` and stats.json.
#pragma once

#include <span>
#include <string>

#include "muslin/contact/crossings.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// Returns JSON: `title`, `time`, `bodies` (a list, each with `name`, `vertices`, `voxels`, `tetrahedra`,
/// `springs.edge`, `.face_diagonal`, `.body_diagonal`, `mass`, `coverage`, `contour_distance`, …),
/// `colliders` (each with `name`, `shape`, `movement`, …), `contact` (null if nothing can touch), `pins`,
/// `attachments`, `forces`, `probes`, `warnings`. `crossings` at the start become a list of the same name,
/// each with `kind`, `bodies`, `faces` (counted from 0 in the mesh, null of round shapes and planes) and
/// `at`.
std::string describe_json(const Model& model, std::span<const Crossing> crossings = {});
/// Returns only `bodies` and `colliders`, for stats.json.
std::string statistics_json(const Model& model);
/// Returns the same as readable text, with at most eight crossings.
std::string describe_text(const Model& model, std::span<const Crossing> crossings = {});

/// Describe a mesh file; `file` is the name to print.
std::string describe_json(const MeshReport& report, const std::string& file);
std::string describe_text(const MeshReport& report, const std::string& file);

}  // namespace muslin
