// PairSearch is the broad phase: it finds features of a contact surface that may come close while its points
// move with boxes.
//
// One binary tree over the triangles, built once; its shape is fixed, its boxes are refitted to each motion
// (van den Bergen 1997). Leaves hold eight triangles, whose boxes are compared in vector code. Boxes are in
// float, rounded outwards. Pairs of leaves come from traversing the tree against itself; features come from
// pairs of triangles by ownership (Curtis, Tamstorf, Manocha, Fast Collision Detection for Deformable Models
// using Representative-Triangles, 2008), so that each pair of features is found once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "muslin/contact/contact_surface.hpp"
#include "muslin/contact/moving_boxes.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct VertexTriangle {
  int point = 0, triangle = 0;
  friend auto operator<=>(const VertexTriangle&, const VertexTriangle&) = default;
};
struct EdgeEdge {
  int first = 0, second = 0;
  friend auto operator<=>(const EdgeEdge&, const EdgeEdge&) = default;
};

/// Pairs that share no point, of bodies that may touch, each once.
struct FeaturePairs {
  std::vector<VertexTriangle> vertex_triangle;
  std::vector<EdgeEdge> edge_edge;
};

/// Not thread-safe; parallel inside. The order of the pairs is the same for any thread count.
class PairSearch {
 public:
  /// Builds the tree for `positions` (#P by 3, [m]), best those at rest, where neighbours on the surface are
  /// neighbours in space.
  PairSearch(std::shared_ptr<const ContactSurface> surface, ConstVectors positions);
  ~PairSearch();
  PairSearch(PairSearch&&) noexcept;
  PairSearch& operator=(PairSearch&&) noexcept;

  /// Finds all pairs that can come within radius + radius + `reach` [m] of each other while every point stays
  /// in its box (#P), all boxes moving at the same time. Some further pairs are found, since boxes only bound
  /// the features. `found` is overwritten; its memory is reused. `moved` (#P, or empty for all points): only
  /// pairs with a point where this is not zero are found; the boxes of the other points, and `reach`, must be
  /// the same as in the last search.
  void find(const MovingBoxes& boxes, double reach, FeaturePairs& found,
            std::span<const std::uint8_t> moved = {});

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace muslin
