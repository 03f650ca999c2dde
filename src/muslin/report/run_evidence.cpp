#include "muslin/report/run_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "muslin/cache/directory_lock.hpp"
#include "muslin/cache/tables.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t places_told = 8;  // of the crossings of a frame
/// The stretch of the caches confirms that of the table up to their rounding.
constexpr double same_stretch = 1e-3;

std::string text_or_empty(const fs::path& file) {
  std::error_code code;
  return fs::exists(file, code) ? read_file(file) : std::string();
}

void read_tables(const RunReader& run, RunEvidence& evidence) {
  const std::string table = read_file(run.directory() / "diagnostics.csv");
  evidence.has_step_columns = table.starts_with(diagnostics_header);
  for (const Diagnostics& row : run.diagnostics()) evidence.quality.add(row);
  const fs::path stretches = run.directory() / "stretch.csv";
  std::error_code code;
  if (!fs::exists(stretches, code)) return;
  for (const LimitedStretch& row : read_stretches(stretches)) {
    evidence.has_stretch_limits = true;
    if (row.frame < run.frame_count()) evidence.quality.add(row);
  }
}

bool has_finite_points(const RunReader& run, int frame) {
  for (int body = 0; body < static_cast<int>(run.bodies().size()); ++body)
    for (const Vec3f& point : run.points(body, SurfaceKind::skin, frame))
      if (!point.allFinite()) return false;
  return true;
}

/// Makes the surfaces to search; null, with the reason, if there are none.
std::optional<CachedSurfaces> surfaces_of(const RunReader& run, RunEvidence& evidence) {
  if (!evidence.summary.contains("contact")) {
    evidence.why_not_searched = "the run is of an earlier version, which did not record its contact";
    return std::nullopt;
  }
  if (evidence.summary["contact"].is_null()) {
    evidence.why_not_searched = "the scene has no contact: nothing keeps its surfaces apart";
    return std::nullopt;
  }
  try {
    return CachedSurfaces(run, read_contact_record(evidence.summary["contact"]));
  } catch (const Error& error) {
    evidence.why_not_searched = error.problem();
    return std::nullopt;
  }
}

void search(const RunReader& run, const CachedSurfaces* surfaces, const Progress& progress,
            RunEvidence& evidence) {
  const int frames = run.frame_count();
  for (int frame = 0; frame < frames; ++frame) {
    progress.at(static_cast<double>(frame) / frames, "looking for crossings");
    if (!has_finite_points(run, frame)) {
      evidence.frames_not_finite.push_back(frame);
      continue;
    }
    if (surfaces == nullptr) continue;
    const std::vector<Crossing> found = surfaces->crossings(frame, surfaces->points(frame));
    if (found.empty()) continue;
    CrossingFrame crossing{frame, found.size(), {}, {}};
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (i < places_told) crossing.places.push_back(surfaces->describe(found[i]));
      crossing.at.push_back(found[i].at);
    }
    evidence.crossing_frames.push_back(std::move(crossing));
  }
}

void find_places(const RunReader& run, const CachedSurfaces* surfaces, RunEvidence& evidence) {
  const std::vector<Diagnostics>& rows = run.diagnostics();
  if (rows.empty()) return;
  const auto narrowest = std::min_element(
      rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.min_distance < b.min_distance; });
  if (std::isfinite(narrowest->min_distance) && surfaces != nullptr) {
    const int frame = static_cast<int>(narrowest - rows.begin());
    evidence.frame_of_gap = frame;
    if (evidence.is_finite(frame)) evidence.gap = surfaces->smallest_gap(frame, surfaces->points(frame));
  }
  const auto longest = std::max_element(
      rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.max_stretch < b.max_stretch; });
  const int frame = static_cast<int>(longest - rows.begin());
  evidence.frame_of_stretch = frame;
  if (!evidence.is_finite(frame)) return;
  const std::optional<StretchPlace> place = find_largest_stretch(run, frame);
  if (place && std::abs(place->ratio - longest->max_stretch) <= same_stretch * longest->max_stretch)
    evidence.stretch = place;
}

}  // namespace

bool RunEvidence::is_finite(int frame) const {
  return !std::binary_search(frames_not_finite.begin(), frames_not_finite.end(), frame);
}

RunEvidence examine(const RunReader& run, const Progress& progress) {
  RunEvidence evidence;
  evidence.summary = Json::parse(read_file(run.directory() / "run.json"));
  evidence.statistics = Json::parse(text_or_empty(run.directory() / "stats.json"), nullptr, false);
  if (evidence.statistics.is_discarded()) evidence.statistics = nullptr;
  evidence.scene_text = text_or_empty(run.directory() / "scene.toml");
  evidence.being_written = DirectoryLock::is_held(run.directory() / "checkpoint", "lock");
  read_tables(run, evidence);
  const std::optional<CachedSurfaces> surfaces = surfaces_of(run, evidence);
  evidence.searched = surfaces.has_value();
  if (surfaces) evidence.triangles_searched = surfaces->triangle_count();
  search(run, surfaces ? &*surfaces : nullptr, progress, evidence);
  find_places(run, surfaces ? &*surfaces : nullptr, evidence);
  return evidence;
}

}  // namespace muslin
