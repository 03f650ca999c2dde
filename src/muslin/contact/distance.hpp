// Computes distances between surface features: a vertex and a triangle, two edges. (A point and a plane need
// no function.) Triangles may be needles, segments or points, edges may be parallel or points; the result is
// always a pair of points of the two features, never NaN for finite input.
//
// Both distances are written as one linear combination of the four points,
//
//   c_A − c_B = Σ wᵢ xᵢ,   Σ wᵢ = 0,   d = |c_A − c_B|,   ∂d/∂xᵢ = wᵢ n,   n = (c_A − c_B) / d,
//
// because moving the closest points within their features does not change the distance to first order
// (the envelope theorem). Regions of the closest point: Ericson, Real-Time Collision Detection (2005), §5.1.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "muslin/core/vectors.hpp"

namespace muslin {

enum class PairKind { vertex_triangle, edge_edge, point_plane };

/// Returns how many of the four points belong to the first feature; the others belong to the second.
constexpr int first_feature_size(PairKind kind) { return kind == PairKind::edge_edge ? 2 : 1; }

struct ClosestPoints {
  Vec3 difference;                ///< c_A − c_B [m]
  double squared_distance = 0;    ///< [m²]
  std::array<double, 4> weights;  ///< w: those of A ≥ 0 and sum to 1, those of B ≤ 0 and sum to −1

  double distance() const { return std::sqrt(squared_distance); }
  /// The corner, edge or interior that holds the closest points: bit i is set if point i has weight.
  unsigned feature() const {
    unsigned bits = 0;
    for (unsigned i = 0; i < 4; ++i) bits |= weights[i] != 0 ? 1U << i : 0U;
    return bits;
  }
};

/// Returns the point nearest to p on the segment a b, as t in a + t (b − a), 0 ≤ t ≤ 1.
inline double closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 u = b - a;
  const double length = u.squaredNorm();
  return length > 0 ? std::clamp(u.dot(p - a) / length, 0.0, 1.0) : 0.0;
}

/// Returns the closest points of vertex p and triangle a b c.
inline ClosestPoints closest_vertex_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, w = p - a;
  const Vec3 normal = u.cross(v);
  const double area = normal.squaredNorm();
  ClosestPoints result;
  // Below this the normal is mostly rounding error: the edges suffice for a needle.
  if (area > 1e-24 * u.squaredNorm() * v.squaredNorm()) {
    const double s = w.cross(v).dot(normal) / area, t = u.cross(w).dot(normal) / area;
    if (s >= 0 && t >= 0 && s + t <= 1) {
      result.difference = w - s * u - t * v;
      result.squared_distance = result.difference.squaredNorm();
      result.weights = {1, -(1 - s - t), -s, -t};
      return result;
    }
  }
  const double ab = closest_on_segment(p, a, b), bc = closest_on_segment(p, b, c),
               ca = closest_on_segment(p, c, a);
  const Vec3 to_ab = w - ab * u, to_bc = p - b - bc * (c - b), to_ca = p - c - ca * (a - c);
  const double d_ab = to_ab.squaredNorm(), d_bc = to_bc.squaredNorm(), d_ca = to_ca.squaredNorm();
  if (d_ab <= d_bc && d_ab <= d_ca) return {to_ab, d_ab, {1, -(1 - ab), -ab, 0}};
  if (d_bc <= d_ca) return {to_bc, d_bc, {1, 0, -(1 - bc), -bc}};
  return {to_ca, d_ca, {1, -ca, 0, -(1 - ca)}};
}

/// Returns the closest points of edges a₀ a₁ and b₀ b₁. For parallel edges one of the nearest end points is
/// used.
inline ClosestPoints closest_edge_edge(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Vec3 u = a1 - a0, v = b1 - b0, r = a0 - b0;
  const Vec3 normal = u.cross(v);
  const double area = normal.squaredNorm(), lengths = u.squaredNorm() * v.squaredNorm();
  ClosestPoints best;
  best.squared_distance = -1;
  if (area > 1e-16 * lengths) {
    const double s = -r.cross(v).dot(normal) / area, t = -r.cross(u).dot(normal) / area;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) {
      best.difference = r + s * u - t * v;
      best.squared_distance = best.difference.squaredNorm();
      best.weights = {1 - s, s, -(1 - t), -t};
      if (area > 1e-8 * lengths) return best;
      // Nearly parallel: s and t may be off, an end point may be nearer.
    }
  }
  const auto consider = [&](const Vec3& difference, double s, double t) {
    const double squared = difference.squaredNorm();
    if (best.squared_distance >= 0 && squared >= best.squared_distance) return;
    best = {difference, squared, {1 - s, s, -(1 - t), -t}};
  };
  const double at_a0 = closest_on_segment(a0, b0, b1), at_a1 = closest_on_segment(a1, b0, b1);
  const double at_b0 = closest_on_segment(b0, a0, a1), at_b1 = closest_on_segment(b1, a0, a1);
  consider(r - at_a0 * v, 0, at_a0);
  consider(r + u - at_a1 * v, 1, at_a1);
  consider(r + at_b0 * u, at_b0, 0);
  consider(r + at_b1 * u - v, at_b1, 1);
  return best;
}

/// Returns the closest points of a pair of the first two kinds: vertex, triangle or a₀, a₁, b₀, b₁.
inline ClosestPoints closest_points(PairKind kind, std::span<const Vec3, 4> x) {
  return kind == PairKind::vertex_triangle ? closest_vertex_triangle(x[0], x[1], x[2], x[3])
                                           : closest_edge_edge(x[0], x[1], x[2], x[3]);
}

}  // namespace muslin
