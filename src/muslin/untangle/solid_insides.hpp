// Finds the points of surfaces that are inside solids.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/untangle/lost_point.hpp"
#include "muslin/untangle/surface_pieces.hpp"

namespace muslin {

/// Returns the points whose generalised winding number about a solid piece is above ½, with the solid's
/// nearest point; by ascending piece, then point. Solids may cross themselves. A piece that lies wholly
/// inside without crossing the solid, deeper than a tenth of its own size, is taken to be where it belongs,
/// such as a load in a closed box. x is #P by 3 [m]; `crossing` are the pairs of triangles that cross.
std::vector<LostPoint> find_solid_insides(const ContactSurface& surface, const SurfacePieces& pieces,
                                          ConstVectors x, std::span<const std::array<int, 2>> crossing);

}  // namespace muslin
