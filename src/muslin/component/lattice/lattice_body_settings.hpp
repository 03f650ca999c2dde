// LatticeBodySettings holds what a scene says of a [[body]] that is a lattice.
#pragma once

#include <optional>

#include "muslin/lattice/lattice.hpp"
#include "muslin/lattice/springs.hpp"

namespace muslin {

struct LatticeBodySettings {
  /// The mesh bounds a solid or is a sheet; `automatic`: a solid if it is closed or has small holes only,
  /// else a sheet.
  enum class Inside { automatic, filled, sheet } inside = Inside::automatic;
  std::optional<double> thickness;  ///< of an open mesh [m]; default: one voxel width
  LatticeSettings lattice;
  bool separate_parts = false;  ///< solids of the mesh share no voxels
  Bracing bracing = Bracing::kuhn;
  enum class Mass { solid, cells } mass = Mass::solid;
  enum class BoundarySprings { full, shared } boundary_springs = BoundarySprings::full;
};

}  // namespace muslin
