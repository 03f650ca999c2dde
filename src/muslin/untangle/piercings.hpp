// Piercings are the points at which edges of a surface pass through its triangles: the corners of the
// contours along which surfaces cross.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct Piercing {
  int edge = 0, triangle = 0;       ///< of the surface
  double along = 0;                 ///< the point is at (1 − along) a + along b of the edge a b
  Vec3 barycentric = Vec3::Zero();  ///< weights of the triangle's corners
  Vec3 at = Vec3::Zero();           ///< the point [m]
};

/// Returns the piercings of crossing pairs of triangles, by ascending edge and triangle, each once. Exact: an
/// edge pierces a triangle if its ends lie strictly on both sides of it and it passes strictly inside; edges
/// that only touch are left out. The numbers of a piercing are rounded. x is #P by 3 [m].
std::vector<Piercing> find_piercings(const ContactSurface& surface, ConstVectors x,
                                     std::span<const std::array<int, 2>> crossing);

}  // namespace muslin
