// EnclosedVolume is the volume that a surface encloses, with its derivatives,
//
//   V = 1/6 Σ a·(b × c)
//
// over the triangles, counter-clockwise seen from outside. Holes are closed by fans of triangles about the
// centroid of their rim, so that a nearly closed surface has a volume. The rim carries the force on the fan.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

class EnclosedVolume {
 public:
  /// `triangles` (#T by 3) index `vertex_count` vertices and have a common orientation; vertices of no
  /// triangle get no force. Errors: input, if an edge has more than two triangles or two that are not
  /// oriented alike.
  EnclosedVolume(const std::vector<Vec3i>& triangles, std::size_t vertex_count);

  std::size_t vertex_count() const { return vertex_count_; }
  /// Those of the surface, then those that close holes; vertex_count() + h is the centre of hole h.
  std::span<const Vec3i> triangles() const { return triangles_; }
  /// The rims of the holes, vertex by vertex, as the triangles run around them.
  const std::vector<std::vector<int>>& holes() const { return holes_; }

  /// V at x, #V by 3 [m³].
  double value(ConstVectors x) const;
  /// g += factor ∂V/∂x.
  void add_gradient(ConstVectors x, double factor, Vectors g) const;
  /// y += factor ∂²V/∂x² p.
  void add_hessian_product(ConstVectors x, ConstVectors p, double factor, Vectors y) const;

  /// An edge a → b. `left` and `right` are the corners opposite to it in the two triangles that share it;
  /// either may be vertex_count() + h, the centre of hole h. ∂²V/∂x_a∂x_b = [x_right − x_left]ₓ/6.
  struct Edge {
    int a, b, left, right;
  };
  const std::vector<Edge>& edges() const { return edges_; }
  /// Returns x followed by the centres of the holes.
  std::vector<Vec3> with_centres(ConstVectors x) const;

 private:
  /// From with_centres, relative to the surface's first vertex: a sum over closed surfaces does not depend on
  /// it.
  std::vector<Vec3> relative(ConstVectors x) const;
  /// to += factor × the share of each vertex; the shares of the centres are divided among their rims.
  template <class Share>
  void add_to_vertices(double factor, const Share& share, Vectors to) const;

  std::size_t vertex_count_;
  std::vector<Vec3i> triangles_;  // with those of the fans
  std::vector<std::vector<int>> holes_;
  std::vector<Edge> edges_;
  std::vector<int> first_;                    // by vertex and centre: of its corners
  std::vector<std::array<int, 2>> opposite_;  // by corner: the next two corners of its triangle
};

}  // namespace muslin
