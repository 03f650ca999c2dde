// Prints a plane slice of the distance field as text, for `muslin field`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// The plane where coordinate `axis` (0, 1, 2 for x, y, z) equals `value` [m].
struct Slice {
  int axis = 2;
  double value = 0;
};

/// Parses a slice such as `z=0` or `x=0.5`. Errors: usage.
Slice parse_slice(std::string_view text);

/// Parses a margin in rings of samples, 0 … 1000: `N` for all axes, `X,Y,Z` for each axis, or `X,Y`, where Z
/// equals Y. Errors: usage.
Vec3i parse_margin(std::string_view text);

struct FieldPrintSettings {
  double voxel_width = 1;        ///< distance between samples [m], > 0
  std::optional<Slice> slice;    ///< if not given: through the middle of the mesh, across its thinnest axis
  Vec3i margin = Vec3i::Ones();  ///< sample rings outside the mesh's bounding box, along x, y, z
  std::optional<double> thickness;  ///< of a mesh with a boundary [m]; if not given, one voxel width; 0 takes
                                    ///< the mesh as a solid with holes. Ignored for closed meshes
  bool csv = false;
};

/// Returns signed distances on the slice plane, at integer multiples of the voxel width in world coordinates:
/// all samples inside the bounding box of the mesh (after thickening, if any) and `margin` rings around them.
///
/// As a table: three decimals, columns by ascending x, rows by descending y (for a slice x = c: columns z,
/// rows y; for y = c: columns x, rows z). As CSV: a header and one row `x,y,z,distance` for each sample in
/// the same order, with all digits.
///
/// The thesis (Thanh Ho, Cloth – Modeling, Deformation, and Simulation, 2016) prints three such tables, width
/// 1, slice z=0: figure 5.2 is the box [−0.1,10.1]×[−0.1,6.1]×[−0.1,0.1]; figure 5.9 the box
/// [0.1,9.9]×[0.1,5.9]×[−0.15,0.15] with margin 1; figure 4.8 a corner of a box of half thickness 0.3 that
/// starts at x = 0.1, y = 0.6 modulo 1, with margin 3,1.
/// Errors: usage, if a setting is invalid or there would be more than 10⁷ samples.
std::string print_field(const Mesh& mesh, const FieldPrintSettings& settings);

}  // namespace muslin
