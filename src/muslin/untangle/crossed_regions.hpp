// Finds the regions of open surfaces that contours of crossings cut off: global intersection analysis after
// Baraff, Witkin, Kass, Untangling cloth (2003).
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/untangle/lost_point.hpp"
#include "muslin/untangle/piercings.hpp"
#include "muslin/untangle/surface_pieces.hpp"

namespace muslin {

/// Returns the points of regions that have to pass back through the surface which cuts them off. Contours
/// divide a piece into regions; each is before or behind the surface that cuts it, by the normals there. Of
/// two pieces, the layers of their bodies tell which regions are wrong: the outer piece belongs before the
/// inner one. Without layers it is the side with the lesser area, both pieces counted together. Within a piece
/// all regions but the largest are wrong that are an odd number of contours from it. Pieces that are not
/// divided, such as a sheet with a slit cut by another one, have no wrong region. `decided` keeps the wrong side
/// of each pair of pieces from call to call, so that a repair does not turn back half way.
std::vector<LostPoint> find_crossed_regions(const ContactSurface& surface, const SurfacePieces& pieces,
                                            ConstVectors x, std::span<const Piercing> piercings,
                                            std::map<std::pair<int, int>, int>& decided);

}  // namespace muslin
