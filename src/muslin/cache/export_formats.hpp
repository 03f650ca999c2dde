// Declares the writers of export_run for glTF, USD and VTK.
#pragma once

#include <filesystem>

#include "muslin/cache/export.hpp"

namespace muslin {

/// NAME.SUFFIX → NAME.0012.SUFFIX
std::filesystem::path numbered(const std::filesystem::path& file, int frame);

/// glTF 2.0: .glb, or .gltf with its buffer in a .bin beside it. The mesh is that of frame 0; morph target
/// n − 1 leads to frame n, and linear weights lead from frame to frame.
void export_gltf(const RunReader& run, const std::filesystem::path& file, int body, SurfaceKind surface,
                 const Progress& progress);

/// USD as text: metres, y up, a time code per frame.
void export_usd(const RunReader& run, const std::filesystem::path& file, const ExportOptions& options,
                const Progress& progress);

/// VTK unstructured grids, one a frame, and a .pvd with their times.
void export_vtu(const RunReader& run, const std::filesystem::path& file, int body, const Progress& progress);

}  // namespace muslin
