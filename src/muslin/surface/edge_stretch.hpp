// EdgeStretch measures the stretch of a surface along its edges.
#pragma once

#include <array>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"

namespace muslin {

/// The edges of a mesh at rest, on which stretch is measured. Edges without length are left out.
class EdgeStretch {
 public:
  explicit EdgeStretch(const Mesh& mesh);

  struct Edge {
    std::array<int, 2> ends;  ///< vertices, the lower one first
    double rest_length = 0;   ///< [m]
  };
  const std::vector<Edge>& edges() const { return edges_; }

  /// Returns, per vertex, the largest stretch of its edges in percent of the rest length; compression counts
  /// as 0.
  std::vector<double> at(ConstVectors positions) const;

 private:
  std::vector<Edge> edges_;
};

}  // namespace muslin
