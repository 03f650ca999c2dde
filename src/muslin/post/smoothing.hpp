// Smooths a surface without shrinking it.
//
// Source: Taubin, A Signal Processing Approach to Fair Surface Design, SIGGRAPH 1995.
#pragma once

#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// Moves every vertex towards the mean of its neighbours and back by a little more, in rounds: a low-pass
/// filter over the edges of the mesh that keeps the lowest wave numbers. A vertex on the border, or on an
/// edge of three and more faces, has its neighbours along such edges only, so that a hem stays a curve. A
/// corner, where the border turns by more than 45° at rest or more or fewer than two of these edges meet,
/// keeps its place.
class Smoothing {
 public:
  /// The mesh at rest; `rounds` ≥ 0, each of a step inwards and one outwards.
  Smoothing(const Mesh& mesh, int rounds);
  /// Returns the smoothed points of the same mesh, #V by 3.
  std::vector<Vec3> points(ConstVectors positions) const;

 private:
  int rounds_;
  std::vector<int> offsets_, neighbours_;  ///< of vertex v, from offsets_[v] to offsets_[v + 1] − 1
};

}  // namespace muslin
