// Computes a safe fraction of a straight-line motion of two features, by conservative advancement.
//
// At time t let d be the distance and n the direction of the closest points. Two lower bounds hold
// afterwards:
//
//   d(t + τ) ≥ d − τ max |uᵢ − uⱼ|                           (no point of A nears one of B faster)
//   d(t + τ) ≥ min n·(xᵢ − xⱼ + τ (uᵢ − uⱼ))                  (n stays a separating direction)
//
// over points i of A and j of B, because the difference of any two points of the features is a convex
// combination of xᵢ − xⱼ. The larger of the two steps that these bounds allow is taken, then both bounds are
// recomputed. The first is conservative advancement (Mirtich 1996; Zhang, Lee, Kim 2006; additive form: Li,
// Kaufman, Jiang, Codimensional Incremental Potential Contact, 2021); the second lets features slide past and
// away from each other, and two faces meet, in one step.
#pragma once

#include <span>

#include "muslin/contact/distance.hpp"

namespace muslin {

/// Returns the largest t in [0, 1] found such that the features at x + s u (#4 by 3, [m]) keep a distance of
/// at least `required` [m] for all s in [0, t]. `required` must be less than the distance at s = 0. If t < 1,
/// the distance there exceeds `required` by at most the smaller of `tolerance` [m] and a tenth of the initial
/// slack. t > 0 always.
double safe_fraction(PairKind kind, std::span<const Vec3, 4> x, std::span<const Vec3, 4> u, double required,
                     double tolerance);

/// Returns the rounding error of a distance between points of coordinates up to `size` [m].
constexpr double distance_rounding(double size) { return 4e-15 * size; }

}  // namespace muslin
