#include "muslin/component/contact_part.hpp"

namespace muslin {

int ContactPart::add_point(std::span<const SurfaceMap::Entry> row, const Vec3& at) {
  entries.insert(entries.end(), row.begin(), row.end());
  offsets.push_back(static_cast<int>(entries.size()));
  rest.push_back(at);
  return static_cast<int>(rest.size()) - 1;
}

void ContactPart::add_triangle(const Vec3i& points, int face) {
  triangles.push_back(points);
  faces.push_back(face);
}

void ContactPart::add_mesh(const Mesh& mesh, const Triangulation& cut, const Embedding& skin) {
  const int first = static_cast<int>(rest.size());
  std::vector<SurfaceMap::Entry> row;
  for (std::size_t p = 0; p < skin.size(); ++p) {
    row.clear();
    for (std::size_t s = 0; s < 8; ++s) {
      // A vertex may occur twice, with weight 0.
      if (skin.weights[p][s] != 0) row.push_back({skin.vertices[p][s], skin.weights[p][s]});
    }
    add_point(row, mesh.positions[p]);
  }
  for (std::size_t t = 0; t < cut.triangles.size(); ++t)
    add_triangle(cut.triangles[t] + Vec3i::Constant(first), cut.faces[t]);
}

}  // namespace muslin
