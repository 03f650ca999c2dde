// Points carried by a lattice: a linear map x = J q from lattice vertices to points.
#pragma once

#include <array>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/lattice/lattice.hpp"

namespace muslin {

/// Each point is a weighted sum of at most eight lattice vertices; the weights of a point add up to 1.
struct Embedding {
  std::vector<std::array<int, 8>> vertices;    ///< #P; unused slots repeat a vertex with weight 0
  std::vector<std::array<double, 8>> weights;  ///< #P

  std::size_t size() const { return vertices.size(); }
  /// points = J q; q is #V by 3, points #P by 3.
  void apply(ConstVectors q, Vectors points) const;
  /// forces_q += Jᵀ f.
  void add_transpose(ConstVectors f, Vectors forces_q) const;
};

/// Trilinear weights of the voxel each point lies in at rest; a point outside all voxels is carried by the
/// nearest one (extrapolated).
Embedding embed(const Lattice& lattice, ConstVectors points);

}  // namespace muslin
