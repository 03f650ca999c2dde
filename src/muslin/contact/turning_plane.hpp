// Computes the distance of a point from a turning plane, which passes through three points.
//
// With x the point and a, b, c those of the plane, n = (b − a) × (c − a) / |…|,
//
//   d = n·(x − a),   ∂d/∂xᵢ = wᵢ n,   w = (1, −(1 − s − t), −s, −t),
//
// where a + s (b − a) + t (c − a) is the foot of x in the plane, as for an unbounded triangle.
#pragma once

#include <array>
#include <span>

#include "muslin/core/vectors.hpp"

namespace muslin {

struct OverPlane {
  Vec3 normal = Vec3::Zero();  ///< of length 1; zero if the three points are on a line
  double distance = 0;         ///< [m], negative below
  std::array<double, 4> weights{};
};
/// Returns the distance of x[0] from the plane through x[1], x[2], x[3] (#4 by 3, [m]).
OverPlane over_plane(std::span<const Vec3, 4> x);

/// Returns a t in [0, 1] such that the distance at x + s u (#4 by 3, [m]) is at least `required` [m] for all
/// s in [0, t]; it is positive if the distance at s = 0 is above that. It is 1 or a dyadic fraction below the
/// largest such t.
double safe_fraction_over_plane(std::span<const Vec3, 4> x, std::span<const Vec3, 4> u, double required);

}  // namespace muslin
