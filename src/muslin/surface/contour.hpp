// The contour: marching squares or cubes on the lattice's samples of the distance field. The samples' values
// never change, only their positions, so the topology is built once and every vertex is carried by the
// lattice (Embedding). Closed, also where the solid ends exactly on the lattice's boundary.
#pragma once

#include <span>

#include "muslin/field/signed_distance.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/lattice/embedding.hpp"
#include "muslin/lattice/lattice.hpp"

namespace muslin {

enum class ContourMethod {
  squares,  ///< flat shapes: 16 cases in the plane, extruded over the solid's thickness
  cubes,    ///< solids: 256 configurations
};

struct Contour {
  ContourMethod method = ContourMethod::cubes;
  Mesh mesh;            ///< triangles at rest, outward oriented, closed
  Embedding embedding;  ///< of mesh.positions
  double distance = 0;  ///< largest distance from a contour vertex or face centre to the solid's surface [m]
};

/// `solid` is the closed mesh the lattice was built from.
Contour build_contour(const Lattice& lattice, const Mesh& solid, const SignedDistance& distance,
                      ContourMethod method);

}  // namespace muslin
