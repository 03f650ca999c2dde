// Selection is the `where` of a pin or force: criteria that choose vertices of a component.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

/// Selects the vertices of a body (of its lattice, or of its mesh if it is a shell) that satisfy every given
/// criterion. Coordinates are those of the world at rest, after the body has been placed.
struct Selection {
  struct BoxShape {
    Vec3 min, max;
  };
  struct SphereShape {
    Vec3 center;
    double radius;
  };
  /// |(x − point)·normal| ≤ distance
  struct PlaneShape {
    Vec3 point, normal;              ///< the normal has length 1
    std::optional<double> distance;  ///< [m]; default: half a voxel width (shell: half a mean edge), so that
                                     ///< one layer is always met
  };
  /// Within `distance` of the segment.
  struct LineShape {
    Vec3 a, b;
    std::optional<double> distance;  ///< [m]; default: ¾ of a voxel width or mean edge, so that a line in the
                                     ///< middle of a sheet of one voxel meets both of its sides
  };
  std::optional<std::string> group;  ///< the vertices that carry this group of the body's mesh
  std::optional<BoxShape> box;
  std::optional<SphereShape> sphere;
  std::optional<PlaneShape> plane;
  std::optional<LineShape> line;
  std::vector<Vec3> nearest;  ///< the vertex nearest to each point, and all that are equally near
  Place place;
};

}  // namespace muslin
