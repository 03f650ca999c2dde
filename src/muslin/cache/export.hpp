// Exports a run to the file formats of other programs.
#pragma once

#include <filesystem>
#include <string>

#include "muslin/api.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/core/progress.hpp"

namespace muslin {

struct ExportOptions {
  std::string body;                         ///< empty: the only body (.usda: all of them)
  SurfaceKind surface = SurfaceKind::skin;  ///< not for .vtu, which shows the lattice
};

/// Writes the run by the suffix of `file`:
///   .pc2 .mdd    point caches for the surface's mesh
///   .obj .ply    one mesh per frame, NAME.0000.obj, …
///   .glb .gltf   a mesh with a morph target per frame and an animation of their weights
///   .usda        meshes with time samples of points, velocities and extents
///   .vtu         its voxels or triangles per frame with displacement, velocity, stretch, and NAME.pvd
/// Each file appears when it is complete. Errors: usage, for another suffix or an unknown body; file.
MUSLIN_API void export_run(const RunReader& run, const std::filesystem::path& file,
                           const ExportOptions& options = {}, const Progress& progress = {});

}  // namespace muslin
