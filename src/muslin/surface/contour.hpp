// Contour is the surface found by marching squares or cubes on the lattice's samples of the distance field.
// The samples' values are constant and only their positions change, so the topology is built once and the
// lattice carries every vertex (Embedding). The contour is closed, even where the solid ends exactly on the
// lattice's boundary. Source: Lorensen and Cline, Marching Cubes, 1987; tables and rules in
// docs/theory/contour.md.
#pragma once

#include <span>

#include "muslin/api.hpp"
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
  /// Largest distance between the contour and the solid's surface at rest [m]: from the contour's vertices
  /// and face centres to the surface, and from the solid's vertices to the contour, whichever is farther. The
  /// diagonal of the solid's bounding box if the contour is empty.
  double distance = 0;
};

/// `solid` is the closed mesh the lattice was built from, `distance` its field. The mesh is a closed
/// 2-manifold, each edge traversed once in either direction.
///
/// Cubes lose features with no lattice vertex inside, in particular walls thinner than a voxel; the mesh is
/// empty if there is nothing else. Squares give the outline in the middle of the solid's thickness, extruded
/// to its bounds; the solid is thin along the axis of the lattice's smallest extent, which must be one voxel.
/// In both cases `Contour::distance` measures the features missed between samples. Errors: input, if squares
/// are requested for a lattice thicker than one voxel.
MUSLIN_API Contour build_contour(const Lattice& lattice, const Mesh& solid, const SignedDistance& distance,
                                 ContourMethod method);

}  // namespace muslin
