// Finds where a run is stretched most, from its caches.
#pragma once

#include <optional>
#include <string>

#include "muslin/cache/run_reader.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct StretchPlace {
  double ratio = 1;  ///< length over the length at the start
  std::string body;
  Vec3 at = Vec3::Zero();  ///< middle of the triangle, or of the spring [m]
};

/// Returns the triangle of a shell, or the spring of a voxel, that is stretched most at a frame, relative to
/// the start; nothing if no body deforms. A shell whose shape at rest is another mesh, or that starts
/// stretched, has another stretch than this. Errors: file.
std::optional<StretchPlace> find_largest_stretch(const RunReader& run, int frame);

}  // namespace muslin
