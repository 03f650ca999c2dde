// The connected parts of a model: what springs, triangles or a rigid frame hold together.
#pragma once

#include <vector>

#include "muslin/scene/model.hpp"

namespace muslin {

struct ModelParts {
  std::vector<int> of_vertex;  ///< #V
  std::vector<double> edges;   ///< by part, typical distance of neighbouring vertices [m]
  std::vector<double> sizes;   ///< by part, diagonal of its bounds at the start, of rigid ones that of the largest [m]
  std::vector<double> longest_steps;  ///< by part, beyond which single precision loses its masses [s]

  std::size_t count() const { return edges.size(); }
};

/// Vertices of no component are one part.
ModelParts find_parts(const Model& model);

}  // namespace muslin
