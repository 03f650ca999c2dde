// Exact predicates on points, segments and triangles give the answer of exact arithmetic on the given
// doubles, for all finite doubles, whatever their size. They are the reference for contact.
//
// A floating-point filter with a proven error bound decides nearly always; otherwise the determinant is
// computed as an expansion, an exact sum of doubles (Shewchuk, Adaptive Precision Floating-Point Arithmetic
// and Fast Robust Geometric Predicates, 1997). Coordinates so large or small that an expansion could overflow
// or underflow are evaluated with integers of any length.
#pragma once

#include <array>

#include "muslin/core/vectors.hpp"

namespace muslin {

using Segment = std::array<Vec3, 2>;
using Triangle = std::array<Vec3, 3>;

/// Returns the sign (−1, 0, 1) of det [b − a, c − a, d − a]: positive if d lies on the side of the plane a b
/// c to which (b − a) × (c − a) points, zero exactly if the four points lie in a plane.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Return true if the closed sets share a point; segments and triangles may be flat, needles or points.
bool segments_meet(const Segment& s, const Segment& t);
bool segment_meets_triangle(const Segment& s, const Triangle& t);
bool triangles_meet(const Triangle& s, const Triangle& t);

/// Returns true if triangles v a b and v c d share a point other than v. A triangle without area whose corner
/// v lies on its edge a b meets any other.
bool triangles_meet_beyond_vertex(const Vec3& v, const Segment& ab, const Segment& cd);

/// Returns true if triangles u v a and u v b share a point off the line u v: they are folded flat onto each
/// other.
bool triangles_meet_beyond_edge(const Segment& uv, const Vec3& a, const Vec3& b);

}  // namespace muslin
