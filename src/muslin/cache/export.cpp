#include "muslin/cache/export.hpp"

#include <fmt/format.h>

#include "muslin/cache/export_formats.hpp"
#include "muslin/cache/point_cache.hpp"
#include "muslin/core/error.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;

void export_meshes(const RunReader& run, const fs::path& file, ExportedSurface& surface,
                   const Progress& progress) {
  for (int frame = 0; frame < run.frame_count(); ++frame) {
    progress.at(static_cast<double>(frame) / run.frame_count(), "export");
    write_mesh(numbered(file, frame), surface.mesh(), widened(surface.points(frame)));
  }
}

/// Returns the surfaces that a file of this suffix holds.
std::vector<ExportedSurface> surfaces_of(const RunReader& run, const std::string& suffix,
                                         const ExportOptions& options) {
  std::vector<ExportedSurface> surfaces;
  const bool all = suffix == ".usda" && options.body.empty();
  if (all && !options.carry.empty() && run.bodies().size() > 1)
    throw Error(ErrorKind::usage, "one mesh cannot be carried by every body",
                "name the body that carries it");
  for (int body = 0; all && body < static_cast<int>(run.bodies().size()); ++body)
    surfaces.emplace_back(run, body, options);
  if (!all) surfaces.emplace_back(run, run.find_body(options.body), options);
  return surfaces;
}

void add(ExportReport& report, const ExportReport& surface) {
  report.frames_drawn_in += surface.frames_drawn_in;
  report.frames_crossing += surface.frames_crossing;
  if (surface.most_crossings <= report.most_crossings) return;
  report.most_crossings = surface.most_crossings;
  report.frame_of_most = surface.frame_of_most;
}

}  // namespace

fs::path numbered(const fs::path& file, int frame) {
  return file.parent_path() /
         fmt::format("{}.{:04}{}", file.stem().string(), frame, file.extension().string());
}

ExportReport export_run(const RunReader& run, const fs::path& file, const ExportOptions& options,
                        const Progress& progress) {
  const std::string suffix = file.extension().string();
  if (run.frame_count() == 0) {
    throw Error(ErrorKind::input, {run.directory().string()}, "the run has no finished frame",
                "run the scene first");
  }
  const bool known = suffix == ".pc2" || suffix == ".mdd" || suffix == ".obj" || suffix == ".ply" ||
                     suffix == ".glb" || suffix == ".gltf" || suffix == ".usda" || suffix == ".vtu";
  if (!known) {
    throw Error(ErrorKind::usage, {file.string()}, "cannot export to \"" + suffix + "\"",
                "use .pc2, .mdd, .obj, .ply, .usda, .glb, .gltf or .vtu");
  }
  if (suffix == ".vtu") {
    if (options.smooth != 0 || options.subdivide != 0 || !options.carry.empty() || options.thickness != 0)
      throw Error(ErrorKind::usage, {file.string()}, "a .vtu shows the simulated elements as they are",
                  "smooth, subdivide, carry or thicken in another format");
    export_vtu(run, file, run.find_body(options.body), progress);
    return {};
  }
  std::vector<ExportedSurface> surfaces = surfaces_of(run, suffix, options);
  ExportedSurface& surface = surfaces.front();
  const int frames = run.frame_count();
  const FramePoints at = [&](int frame) {
    progress.at(static_cast<double>(frame) / frames, "export");
    return surface.points(frame);
  };
  const std::size_t points = surface.mesh().vertex_count();
  if (suffix == ".usda") {
    export_usd(run, file, surfaces, progress);
  } else if (suffix == ".pc2") {
    write_pc2(file, frames, points, at);
  } else if (suffix == ".mdd") {
    write_mdd(file, frames, points, run.frame_rate(), at);
  } else if (suffix == ".obj" || suffix == ".ply") {
    export_meshes(run, file, surface, progress);
  } else {
    export_gltf(run, file, surface, progress);
  }
  ExportReport report;
  for (const ExportedSurface& of : surfaces) add(report, of.report());
  return report;
}

}  // namespace muslin
