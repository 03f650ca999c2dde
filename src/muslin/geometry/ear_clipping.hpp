// EarClipping cuts a polygon into triangles by clipping ears (G. H. Meisters, "Polygons have ears", American
// Mathematical Monthly 82, 1975).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Keeps its buffers between polygons; one object per thread.
class EarClipping {
 public:
  /// Cuts `face` (n ≥ 4 indices into positions) into exactly n − 2 triangles of its own vertices, written to
  /// `triangles`. The polygon is seen along its Newell normal. Where no proper ear is left (the outline
  /// crosses itself, or has no area) corners are clipped in order, so the count holds for any input.
  void cut(ConstVectors positions, std::span<const int> face, std::span<Vec3i> triangles);

 private:
  enum class Rule { strict, touching };
  bool project(ConstVectors positions, std::span<const int> face);
  double turn(int corner) const;
  bool is_ear(int corner, Rule rule) const;
  void clip(int corner);
  int next_ear(int any, Rule& rule, int& rounds);
  void fill_buckets();
  std::size_t bucket(const Vec2& point) const;

  std::vector<Vec2> points_;   // corners in the plane, counterclockwise
  std::vector<int> previous_;  // linked ring of the corners not yet clipped
  std::vector<int> next_;
  std::vector<char> blocking_;   // not strictly convex: may lie in the triangle of another corner
  std::vector<int> in_bucket_;   // blocking corners sorted by bucket of a uniform grid …
  std::vector<int> bucket_end_;  // … and where each bucket ends
  std::vector<int> queue_;       // corners that may be ears, tried first come, first served
  std::size_t head_ = 0;
  bool found_since_round_ = false;
  Vec2 grid_origin_, cells_per_length_;
  int cells_ = 0;  // per axis
};

}  // namespace muslin
