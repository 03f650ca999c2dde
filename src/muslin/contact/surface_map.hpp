// SurfaceMap maps the degrees of freedom linearly to surface points, x = J q: the vertices of a shell (J =
// 1), the skin of a lattice (trilinear weights), points of an affine body (weights of its four control
// points), the centre of a ball, a collider's vertices moved along keyframes. Contact is formulated in x; Jᵀ
// maps its forces to q.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// J, sparse, by rows; immutable. Each point is an affine combination of vertices: weights sum to 1, so that
/// a translation of all vertices translates all points alike.
class SurfaceMap {
 public:
  struct Entry {
    int vertex = 0;     ///< of q
    double weight = 1;  ///< of that vertex in the point
  };

  /// Returns the map whose points are the vertices.
  static SurfaceMap identity(std::size_t vertex_count);
  /// The entries of point p are entries[offsets[p]] … entries[offsets[p + 1] − 1], offsets #P + 1, each
  /// vertex once in a row. Errors: usage, if the offsets do not ascend, a vertex does not exist or the
  /// weights of a point do not sum to 1 (to 1e-9).
  SurfaceMap(std::size_t vertex_count, std::vector<int> offsets, std::vector<Entry> entries);

  std::size_t vertex_count() const { return vertex_count_; }
  std::size_t point_count() const { return offsets_.size() - 1; }
  bool is_identity() const { return identity_; }
  /// True if no weight is negative: points lie between their vertices.
  bool is_convex() const { return convex_; }
  std::span<const Entry> row(std::size_t point) const { return slice(entries_, offsets_, point); }
  /// Returns the points that depend on vertex v, as (point, weight).
  std::span<const Entry> column(std::size_t v) const { return slice(columns_, column_offsets_, v); }

  /// x = J q: q #V by 3, x #P by 3.
  void apply(ConstVectors q, Vectors x) const;
  /// g += Jᵀ f: f #P by 3, g #V by 3.
  void add_transpose(ConstVectors f, Vectors g) const;

 private:
  static std::span<const Entry> slice(const std::vector<Entry>& all, const std::vector<int>& offsets,
                                      std::size_t i) {
    return {all.data() + offsets[i], static_cast<std::size_t>(offsets[i + 1] - offsets[i])};
  }

  std::size_t vertex_count_ = 0;
  bool identity_ = false, convex_ = true;
  std::vector<int> offsets_, column_offsets_;
  std::vector<Entry> entries_, columns_;
};

}  // namespace muslin
