// Which pairs of features may come close while their points stay in boxes. A plane across the closest points
// of a pair proves for most that they may not. In float, eight pairs at once; errs on the side of keeping a
// pair.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/contact/distance.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

class PairCulling {
 public:
  /// Each point in its box lower … upper (#P by 3, [m]); planes are laid across the closest points at `at`.
  void set_points(const ContactSurface& surface, ConstVectors at, ConstVectors lower, ConstVectors upper);

  /// For pair i, given by its four points: distance[i] is negative unless it may come within radius + radius
  /// + `reach` [m]; if it may, its features are at least distance[i] apart at `at` [m]. `kind` is
  /// vertex_triangle or edge_edge.
  void find_near(PairKind kind, std::span<const std::array<int, 4>> pairs, double reach,
                 float* distance) const;

 private:
  struct Point {
    float at[3], middle[3], half[3];  ///< relative to the centre of all boxes [m]
    float radius;
  };
  std::vector<Point> points_;
  float rounding_ = 0;  ///< of a distance between points [m]
};

}  // namespace muslin
