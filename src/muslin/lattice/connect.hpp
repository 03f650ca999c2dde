// Connects kept voxels to a lattice: its vertices and each voxel's corners.
#pragma once

#include "muslin/lattice/lattice.hpp"

namespace muslin {

/// Fills in `vertices` and `voxel_vertices` from the sorted `voxels`. Throws Error(input) if the number of
/// vertices exceeds the range of int.
void connect_voxels(Lattice& lattice);

}  // namespace muslin
