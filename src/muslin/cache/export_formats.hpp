// Declares the writers of export_run for glTF, USD and VTK.
#pragma once

#include <filesystem>
#include <span>

#include "muslin/cache/exported_surface.hpp"

namespace muslin {

/// Returns NAME.0012.SUFFIX for NAME.SUFFIX and frame 12.
std::filesystem::path numbered(const std::filesystem::path& file, int frame);

/// Writes glTF 2.0: .glb, or .gltf with its buffer in a .bin beside it. The mesh is that of frame 0; morph
/// target n − 1 is frame n, and weights interpolate linearly between frames.
void export_gltf(const RunReader& run, const std::filesystem::path& file, ExportedSurface& surface,
                 const Progress& progress);

/// Writes USD as text: metres, y up, one time code per frame.
void export_usd(const RunReader& run, const std::filesystem::path& file, std::span<ExportedSurface> surfaces,
                const Progress& progress);

/// Writes VTK unstructured grids, one per frame, and a .pvd with their times.
void export_vtu(const RunReader& run, const std::filesystem::path& file, int body, const Progress& progress);

}  // namespace muslin
