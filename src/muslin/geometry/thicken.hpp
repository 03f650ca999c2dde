// Thickens a sheet so that it encloses a solid.
#pragma once

#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// True if no edge is used by one face only: the mesh has no boundary.
bool is_closed(const Mesh& mesh);

/// Returns a closed, outward oriented mesh of the points within half the thickness [m] of the sheet, measured
/// along its normals: a copy of the faces on either side and a wall along every open edge. The rim is sharp
/// and ends where the sheet ends (a flat rectangle becomes a box of the same length and width).
///
/// Vertices move along the angle-weighted normal of their faces (Thürmer, Wüthrich 1998), by half the
/// thickness over the cosine of its angle to the faces, so that faces move by half the thickness where the
/// sheet is creased too. The move is limited to the whole thickness, which is reached at creases sharper than
/// 60°. Sheets that meet in an edge of three or more faces are thickened separately, with a wall along that
/// edge; so are the faces of a one-sided sheet (Möbius). Either side has the texture coordinates of the sheet
/// and a wall those of its edge; groups hold both sides and the walls of their faces. Errors: usage, if the
/// thickness is not positive and finite.
Mesh thicken(const Mesh& mesh, double thickness);

}  // namespace muslin
