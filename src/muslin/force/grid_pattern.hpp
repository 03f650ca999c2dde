// GridPattern interpolates vectors on a regular grid.
#pragma once

#include "muslin/force/field.hpp"
#include "muslin/io/vector_grid_file.hpp"

namespace muslin {

/// Trilinear between the nodes, exact for a linear field; zero outside the grid. The falloff counts from the
/// centre.
class GridPattern : public FieldPattern {
 public:
  /// origin: of node (0, 0, 0), relative to the centre [m]; spacing > 0 along each axis [m].
  GridPattern(VectorGrid grid, const Vec3& origin, const Vec3& spacing);
  FieldSample at(const Vec3& place, double time) const override;

 private:
  VectorGrid grid_;
  Vec3 origin_, spacing_;
};

}  // namespace muslin
