// Embedding maps lattice vertices linearly to the points they carry, x = J q; points that nothing carries
// have an offset.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/lattice/lattice.hpp"

namespace muslin {

/// Each point is a weighted sum of at most eight lattice vertices; the weights of a point add up to 1, or
/// are 0 if nothing carries it.
struct MUSLIN_API Embedding {
  std::vector<std::array<int, 8>> vertices;    ///< #P; unused slots repeat a vertex with weight 0
  std::vector<std::array<double, 8>> weights;  ///< #P
  std::vector<Vec3> offsets{};                 ///< #P, added to the points [m]; empty: none

  std::size_t size() const { return vertices.size(); }
  /// points = J q + offsets; q is #V by 3, points #P by 3.
  void apply(ConstVectors q, Vectors points) const;
  /// forces_q += Jᵀ f. The sums run over the points in ascending order, so the bits do not depend on the
  /// number of threads. Runs in parallel after prepare_transpose().
  void add_transpose(ConstVectors f, Vectors forces_q) const;
  /// Lists the points that each of `vertex_count` vertices carries. Call again after changing the weights.
  void prepare_transpose(std::size_t vertex_count);

 private:
  std::vector<std::int64_t> first_;  ///< #V + 1; vertex v carries slots [first_[v], first_[v+1])
  std::vector<std::int64_t> slots_;  ///< 8·point + corner of every nonzero weight
};

/// Returns the trilinear weights of the voxel each point lies in at rest; a point outside all voxels is
/// carried by the nearest one (extrapolated). A point in a face shared by voxels may be carried by any of
/// them: the weights are the same. Points are given where they lie in the grid, before the offsets of slabs.
/// Prepared for the transpose.
MUSLIN_API Embedding embed(const Lattice& lattice, ConstVectors points);

}  // namespace muslin
