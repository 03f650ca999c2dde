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

/// Surfaces whose normals have a larger cosine are layers.
constexpr double layered = 0.5;

/// How two open pieces lie to each other. It is decided once, so that a repair does not turn back half way.
struct Layering {
  bool layers = false;  ///< they lie on each other rather than cut each other
  /// The wrong side of the first piece, of smaller number, and of the second one: 1 before the other piece,
  /// by its normals, −1 behind it.
  int wrong_of_first = 1, wrong_of_second = -1;
};
using Layerings = std::map<std::pair<int, int>, Layering>;  ///< by pieces, the smaller number first

/// Returns the points of regions that have to pass back through the surface which cuts them off. Contours
/// divide a piece into regions; each is before or behind the surface that cuts it, by the normals there. Of
/// two pieces, the layers of their bodies tell which regions are wrong: the outer piece belongs before the
/// inner one. Without layers it is the side with the lesser area, both pieces counted together. Within a
/// piece all regions but the largest are wrong that are an odd number of contours from it. Pieces that are
/// not divided, such as a sheet with a slit cut by another one, have no wrong region. `known` is what earlier
/// calls have decided, to which this one adds.
std::vector<LostPoint> find_crossed_regions(const ContactSurface& surface, const SurfacePieces& pieces,
                                            ConstVectors x, std::span<const Piercing> piercings,
                                            Layerings& known);

}  // namespace muslin
