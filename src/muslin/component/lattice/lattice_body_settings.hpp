// LatticeBodySettings holds what a scene says of a [[body]] that is a lattice.
#pragma once

#include <optional>

#include "muslin/lattice/lattice.hpp"
#include "muslin/lattice/springs.hpp"

namespace muslin {

struct LatticeBodySettings {
  std::optional<double> thickness;  ///< of an open mesh [m]; default: one voxel width
  LatticeSettings lattice;
  Bracing bracing = Bracing::kuhn;
  enum class Mass { solid, cells } mass = Mass::solid;
  enum class BoundarySprings { full, shared } boundary_springs = BoundarySprings::full;
};

}  // namespace muslin
