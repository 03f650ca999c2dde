// Writes every stage between mesh and simulation as files for inspection, for `muslin build`.
#pragma once

#include <filesystem>

#include "muslin/core/progress.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// Writes per body NAME.field.vti (signed distance at the lattice's corners and one voxel around),
/// NAME.voxels.vtu (with fill), NAME.tets.vtu, NAME.springs.vtu (with kind 0 edge, 1 face diagonal, 2 body
/// diagonal), NAME.skin.obj, NAME.solid.obj, NAME.contour.obj; for a shell NAME.shell.vtu (its triangles with
/// their warp) and NAME.skin.obj; and stats.json. Errors: file.
void write_stages(const std::filesystem::path& directory, const Model& model, const Progress& progress = {});

}  // namespace muslin
