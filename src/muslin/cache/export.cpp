#include "muslin/cache/export.hpp"

#include <fmt/format.h>

#include "muslin/cache/export_formats.hpp"
#include "muslin/cache/point_cache.hpp"
#include "muslin/core/error.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;

std::vector<Vec3> widened(const std::vector<Vec3f>& points) {
  std::vector<Vec3> result;
  result.reserve(points.size());
  for (const Vec3f& p : points) result.push_back(p.cast<double>());
  return result;
}

void export_meshes(const RunReader& run, const fs::path& file, int body, SurfaceKind surface,
                   const Progress& progress) {
  for (int frame = 0; frame < run.frame_count(); ++frame) {
    progress.at(static_cast<double>(frame) / run.frame_count(), "export");
    write_mesh(numbered(file, frame), run.mesh(body, surface), widened(run.points(body, surface, frame)));
  }
}

}  // namespace

fs::path numbered(const fs::path& file, int frame) {
  return file.parent_path() /
         fmt::format("{}.{:04}{}", file.stem().string(), frame, file.extension().string());
}

void export_run(const RunReader& run, const fs::path& file, const ExportOptions& options,
                const Progress& progress) {
  const std::string suffix = file.extension().string();
  if (run.frame_count() == 0) {
    throw Error(ErrorKind::input, {run.directory().string()}, "the run has no finished frame",
                "run the scene first");
  }
  if (suffix == ".usda") return export_usd(run, file, options, progress);
  const bool known = suffix == ".pc2" || suffix == ".mdd" || suffix == ".obj" || suffix == ".ply" ||
                     suffix == ".glb" || suffix == ".gltf" || suffix == ".vtu";
  if (!known) {
    throw Error(ErrorKind::usage, {file.string()}, "cannot export to \"" + suffix + "\"",
                "use .pc2, .mdd, .obj, .ply, .usda, .glb, .gltf or .vtu");
  }
  const int body = run.find_body(options.body);
  const SurfaceKind surface = options.surface;
  const int frames = run.frame_count();
  const FramePoints at = [&](int frame) {
    progress.at(static_cast<double>(frame) / frames, "export");
    return run.points(body, surface, frame);
  };
  const std::size_t points = run.mesh(body, surface).vertex_count();
  if (suffix == ".pc2") return write_pc2(file, frames, points, at);
  if (suffix == ".mdd") return write_mdd(file, frames, points, run.frame_rate(), at);
  if (suffix == ".vtu") return export_vtu(run, file, body, progress);
  if (suffix == ".obj" || suffix == ".ply") return export_meshes(run, file, body, surface, progress);
  export_gltf(run, file, body, surface, progress);
}

}  // namespace muslin
