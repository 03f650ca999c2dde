#include "muslin/scene/solid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <vector>

namespace muslin {
namespace {

using Edge = std::pair<int, int>;

std::vector<Edge> boundary_edges(const Mesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(mesh.face_vertices.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t c = 0; c < face.size(); ++c) {
      edges.push_back(std::minmax({face[c], face[(c + 1) % face.size()]}));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> boundary;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    if (j - i == 1) boundary.push_back(edges[i]);
    i = j;
  }
  return boundary;
}

/// Perimeters of the connected pieces of the boundary.
std::vector<double> loop_lengths(const Mesh& mesh, const std::vector<Edge>& boundary) {
  std::vector<int> parent(mesh.vertex_count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) {
      auto& above = parent[static_cast<std::size_t>(v)];
      above = parent[static_cast<std::size_t>(above)];
      v = above;
    }
    return v;
  };
  for (const auto& [a, b] : boundary) parent[static_cast<std::size_t>(root(a))] = root(b);
  std::map<int, double> lengths;
  for (const auto& [a, b] : boundary) {
    lengths[root(a)] +=
        (mesh.positions[static_cast<std::size_t>(a)] - mesh.positions[static_cast<std::size_t>(b)]).norm();
  }
  std::vector<double> result;
  for (const auto& [loop, length] : lengths) result.push_back(length);
  return result;
}

}  // namespace

MeshKind kind_of(const Mesh& mesh, const MeshReport& report) {
  const double size = report.bounds.diagonal().norm();
  const bool encloses = std::abs(report.volume) > 1e-9 * report.area * size;
  if (report.closed) return encloses ? MeshKind::solid : MeshKind::sheet;
  double lids = 0;
  for (const double length : loop_lengths(mesh, boundary_edges(mesh))) {
    lids += length * length / (4 * std::numbers::pi);
  }
  return encloses && lids < 0.02 * report.area ? MeshKind::holed_solid : MeshKind::sheet;
}

Mesh flipped(Mesh mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto begin = mesh.face_offsets[f], end = mesh.face_offsets[f + 1];
    std::reverse(mesh.face_vertices.begin() + begin, mesh.face_vertices.begin() + end);
    if (!mesh.corner_uvs.empty())
      std::reverse(mesh.corner_uvs.begin() + begin, mesh.corner_uvs.begin() + end);
  }
  return mesh;
}

}  // namespace muslin
