// Finds parts of a mesh that lie apart but are closer than their voxels, so that the lattice connects them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "muslin/geometry/mesh.hpp"
#include "muslin/lattice/lattice.hpp"

namespace muslin {

struct SharedVoxels {
  std::size_t parts = 0;          ///< connected parts of the mesh in one part of the lattice
  std::array<int, 2> vertices{};  ///< one of each of two parts, near the other
  double distance = 0;            ///< from the second vertex to the first part's surface [m]
};

/// Parts that cross each other or lie one inside the other are no concern: they are one solid. Returns the
/// first part of the lattice that connects others.
std::optional<SharedVoxels> find_shared_voxels(const Mesh& solid, const Lattice& lattice);

}  // namespace muslin
