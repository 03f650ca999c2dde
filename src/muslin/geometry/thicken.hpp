// Giving a sheet a thickness, so that it encloses a solid.
#pragma once

#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// True if no edge is used by one face only: the mesh has no boundary.
bool is_closed(const Mesh& mesh);

/// A closed, outward oriented mesh of the points within half the thickness of the sheet, measured along its
/// normals: a copy of the faces on either side and a wall along every open edge. The rim is sharp and ends
/// where the sheet ends (a flat rectangle becomes a box of the same length and width). Where faces do not
/// share an orientation (non-manifold edges, soup) each becomes a slab of its own.
Mesh thicken(const Mesh& mesh, double thickness);

}  // namespace muslin
