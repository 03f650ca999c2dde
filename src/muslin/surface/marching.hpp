// Computes marching cubes and marching squares on a lattice's vertices: the raw triangles, from which
// contour.cpp makes a manifold.
#pragma once

#include <cstdint>
#include <vector>

#include "muslin/field/signed_distance.hpp"
#include "muslin/lattice/embedding.hpp"
#include "muslin/lattice/lattice.hpp"
#include "muslin/surface/manifold.hpp"

namespace muslin {

struct MarchedSurface {
  std::vector<Vec3> positions;          ///< #V at rest
  Embedding embedding;                  ///< of the positions
  std::vector<PartTriangle> triangles;  ///< closed, outward oriented; parts are 8·voxel + 0…7
};

MarchedSurface march_cubes(const Lattice& lattice, const SignedDistance& distance);

/// Errors: input, if the lattice is more than one voxel thick along every axis.
MarchedSurface march_squares(const Lattice& lattice, const SignedDistance& distance);

/// Samples at or below this many voxel widths count as inside, so that a solid that ends exactly on the
/// lattice's boundary keeps its outermost layer of samples.
inline constexpr double inside_tolerance = 1e-6;

/// Returns the zero of the distance between `inside` and `outside`, as a fraction of that segment, by regula
/// falsi (Illinois). Stops after `evaluations` of the distance or within tolerance·|outside − inside|. The
/// result is kept 1e-4 away from both ends, so that no triangle is degenerate.
double crossing(const SignedDistance& distance, const Vec3& inside, const Vec3& outside, double value_inside,
                double value_outside, int evaluations, double tolerance);

/// Triangle whose vertices have names instead of numbers.
struct NamedTriangle {
  std::array<std::uint64_t, 3> names{};
  std::int64_t part = 0;
};
/// Numbers the vertices in ascending order of their names; returns the names.
std::vector<std::uint64_t> number_vertices(const std::vector<std::vector<NamedTriangle>>& blocks,
                                           std::vector<PartTriangle>& triangles);

}  // namespace muslin
