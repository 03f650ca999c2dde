// Exports a run to the file formats of other programs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "muslin/api.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/core/progress.hpp"

namespace muslin {

struct ExportOptions {
  std::string body;                         ///< empty: the only body (.usda: all of them)
  SurfaceKind surface = SurfaceKind::skin;  ///< not for .vtu, which shows the lattice
  // The surface is finished in this order; not for .vtu.
  int smooth = 0;     ///< rounds of smoothing, 0 to 1000
  int subdivide = 0;  ///< levels of subdivision, 0 to 8
  std::filesystem::path carry =
      {};                ///< file of a finer mesh that takes its place, modelled where the body's is
  double thickness = 0;  ///< of the solid that is made of the surface [m]; 0: it stays a surface
};

/// Crossings of meshes that bodies carry, with themselves and with other bodies.
struct ExportReport {
  int frames_drawn_in = 0;  ///< frames in which vertices were drawn in to avoid crossings
  int frames_crossing = 0;  ///< frames with crossings all the same
  std::size_t most_crossings = 0;
  int frame_of_most = 0;
};

/// Writes the run by the suffix of `file`:
///   .pc2 .mdd    point caches for the surface's mesh
///   .obj .ply    one mesh per frame, NAME.0000.obj, …
///   .glb .gltf   a mesh with a morph target per frame and an animation of their weights
///   .usda        meshes with time samples of points, velocities and extents
///   .vtu         its voxels or triangles per frame with displacement, velocity, stretch, and NAME.pvd
/// Each file appears when it is complete. Errors: usage, for another suffix, an unknown body or
/// an option out of its range; file; input, for the mesh to carry.
MUSLIN_API ExportReport export_run(const RunReader& run, const std::filesystem::path& file,
                                   const ExportOptions& options = {}, const Progress& progress = {});

}  // namespace muslin
