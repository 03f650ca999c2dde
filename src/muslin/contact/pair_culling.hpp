// PairCulling finds the feature pairs that may come close while their points move with boxes. A separating
// plane between the closest points of a pair rules most pairs out. It works in float, on eight pairs at once,
// and is conservative: rounding can only keep a pair.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/contact/distance.hpp"
#include "muslin/contact/moving_boxes.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

class PairCulling {
 public:
  /// Sets each point with its box (#P); the planes separate the closest points at `at` (#P by 3, [m]).
  void set_points(const ContactSurface& surface, ConstVectors at, const MovingBoxes& boxes);
  /// Sets only the boxes of points whose `moved` (#P) is not zero.
  void set_boxes(std::span<const std::uint8_t> moved, const MovingBoxes& boxes);

  /// For pair i, given by its four points: distance[i] is negative unless it may come within radius + radius
  /// + `reach` [m]; if it may, its features are at least distance[i] apart at `at` [m]. `kind` is
  /// vertex_triangle or edge_edge.
  void find_near(PairKind kind, std::span<const std::array<int, 4>> pairs, double reach,
                 float* distance) const;

 private:
  struct Point {
    float at[3];
    float middle[2][3], half[2][3];  ///< of the box at both ends, relative to the centre of all boxes [m]
    float radius;
  };
  void set_box(std::size_t p, const MovingBoxes& boxes);

  std::vector<Point> points_;
  Vec3 centre_ = Vec3::Zero();
  bool moving_ = false;
  float rounding_ = 0;  ///< of a distance between points [m]
};

}  // namespace muslin
