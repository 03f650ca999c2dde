#include "muslin/surface/edge_stretch.hpp"

#include <algorithm>

namespace muslin {

EdgeStretch::EdgeStretch(const Mesh& mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto corners = mesh.face(f);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const auto [a, b] = std::minmax(corners[c], corners[(c + 1) % corners.size()]);
      const double length =
          (mesh.positions[static_cast<std::size_t>(a)] - mesh.positions[static_cast<std::size_t>(b)]).norm();
      if (length > 0) edges_.push_back({{a, b}, length});
    }
  }
  std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
  const auto same = [](const Edge& a, const Edge& b) { return a.ends == b.ends; };
  edges_.erase(std::unique(edges_.begin(), edges_.end(), same), edges_.end());
}

std::vector<double> EdgeStretch::at(ConstVectors positions) const {
  std::vector<double> stretch(positions.size(), 0.0);
  for (const Edge& edge : edges_) {
    const auto a = static_cast<std::size_t>(edge.ends[0]), b = static_cast<std::size_t>(edge.ends[1]);
    const double percent = 100 * ((positions[a] - positions[b]).norm() / edge.rest_length - 1);
    stretch[a] = std::max(stretch[a], percent);
    stretch[b] = std::max(stretch[b], percent);
  }
  return stretch;
}

}  // namespace muslin
