#include "muslin/component/solid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "muslin/core/disjoint_sets.hpp"
#include "muslin/topology/topology.hpp"

namespace muslin {
namespace {

using Edge = std::pair<int, int>;

std::vector<Edge> boundary_edges(const Mesh& mesh) {
  std::vector<Edge> boundary;
  for_each_edge(edge_uses(mesh), [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1) boundary.emplace_back(edge[0].low, edge[0].high);
  });
  return boundary;
}

/// Perimeters of the connected pieces of the boundary.
std::vector<double> loop_lengths(const Mesh& mesh, const std::vector<Edge>& boundary) {
  DisjointSets loops(mesh.vertex_count());
  for (const auto& [a, b] : boundary) loops.join(a, b);
  std::map<int, double> lengths;
  for (const auto& [a, b] : boundary) {
    lengths[loops.find(a)] +=
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
