// Tubes sewn of flat sheets, for the tests of shells.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "support/sheet.hpp"

#include "muslin/shell/rest_shape.hpp"

namespace muslin::test {

/// The polygons of a sheet closed to a tube about the z axis, one vertex where the sheet has two at the seam.
struct Tube {
  Mesh flat;  ///< the pattern, in the plane y = 0
  Mesh sewn;  ///< with edges as long as those of the pattern
  double radius = 0;

  RestShape pattern() const { return {flat.positions, flat.face_vertices}; }
};

inline Tube sewn_tube(int around, int along, double perimeter, double length) {
  Tube tube;
  tube.flat = flat_sheet(around, along, perimeter, length);
  tube.radius = perimeter / around / (2 * std::sin(std::numbers::pi / around));
  for (int k = 0; k <= along; ++k) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      tube.sewn.positions.emplace_back(tube.radius * std::cos(angle), tube.radius * std::sin(angle),
                                       k * length / along);
    }
  }
  tube.sewn.face_offsets = tube.flat.face_offsets;
  for (const int v : tube.flat.face_vertices)
    tube.sewn.face_vertices.push_back(v % (around + 1) % around + v / (around + 1) * around);
  return tube;
}

}  // namespace muslin::test
