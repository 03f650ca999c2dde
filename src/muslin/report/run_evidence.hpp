// RunEvidence is what a report knows of a run: its files, read once, and what an examination of its caches
// found.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "muslin/cache/run_quality.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/report/cached_surfaces.hpp"
#include "muslin/report/stretch_place.hpp"

namespace muslin {

/// A frame in which surfaces cross.
struct CrossingFrame {
  int frame = 0;
  std::size_t count = 0;            ///< pairs of faces, points in balls and beneath planes included
  std::vector<std::string> places;  ///< a line each, of the first few
  std::vector<Vec3> at;             ///< of all [m]
};

struct RunEvidence {
  nlohmann::ordered_json summary;     ///< run.json
  nlohmann::ordered_json statistics;  ///< stats.json; null if it is missing
  std::string scene_text;             ///< scene.toml; empty if it is missing
  bool being_written = false;         ///< by another process, at this moment
  bool has_step_columns = false;      ///< diagnostics.csv says which steps converged
  RunQuality quality;                 ///< of all complete frames
  bool has_stretch_limits = false;

  std::vector<int> frames_not_finite;  ///< in which a cached position is not a number, ascending
  bool is_finite(int frame) const;     ///< false in these
  /// True if the caches were searched for crossings; otherwise the reason is below.
  bool searched = false;
  std::string why_not_searched;
  std::size_t triangles_searched = 0;  ///< of each frame
  std::vector<CrossingFrame> crossing_frames;

  std::optional<int> frame_of_gap;  ///< with the smallest gap, if one is below the contact distance
  std::optional<Gap> gap;           ///< at the end of that frame
  std::optional<int> frame_of_stretch;
  std::optional<StretchPlace> stretch;  ///< if the caches confirm the number of the table
};

/// Reads the files of a run and examines the caches of all its complete frames. Errors: file; input, if a
/// file is damaged; interrupted.
RunEvidence examine(const RunReader& run, const Progress& progress);

}  // namespace muslin
