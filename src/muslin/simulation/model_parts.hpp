// ModelParts lists the connected parts of a model: vertices joined by springs, triangles or a rigid frame.
#pragma once

#include <vector>

#include "muslin/scene/model.hpp"

namespace muslin {

struct ModelParts {
  std::vector<int> of_vertex;  ///< #V
  std::vector<double> edges;   ///< by part, typical distance of neighbouring vertices [m]
  /// By part, diagonal of its bounds at the start; of rigid parts, that of the largest [m].
  std::vector<double> sizes;
  std::vector<double> longest_steps;  ///< by part, for which single precision resolves its masses [s]

  std::size_t count() const { return edges.size(); }
};

/// Finds the parts. Vertices of no component form one part.
ModelParts find_parts(const Model& model);

}  // namespace muslin
