// Makes strips of many triangulations, to show that a result does not depend on the mesh.
#pragma once

#include <string>

#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Returns a strip in the plane z = 0 from x = 0 to 1 and y = 0 to `width`, n cells long, with a row of cells
/// before x = 0 if `clamped`. `kind` is one of: right, left, alternating, crossed, equilateral, jittered,
/// random (diagonals), delaunay (of points moved at random). The same arguments give the same mesh.
Mesh triangulated_strip(const std::string& kind, int n, double width, bool clamped);

}  // namespace muslin
