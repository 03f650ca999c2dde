#include "muslin/component/lattice/shared_voxels.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "muslin/component/lattice/solids.hpp"
#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/index.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/lattice/embedding.hpp"

namespace muslin {
namespace {

/// The part of the lattice to which each vertex of the mesh belongs.
std::vector<int> parts_of_lattice(const Mesh& mesh, const Lattice& lattice) {
  DisjointSets parts(lattice.vertex_count());
  for (const auto& corners : lattice.voxel_vertices)
    for (const int v : corners) parts.join(corners[0], v);
  const Embedding embedding = embed(lattice, mesh.positions);
  std::vector<int> result;
  result.reserve(embedding.vertices.size());
  for (const auto& carriers : embedding.vertices) result.push_back(parts.find(carriers[0]));
  return result;
}

}  // namespace

std::optional<SharedVoxels> find_shared_voxels(const Mesh& solid, const Lattice& lattice) {
  const std::vector<int> parts = parts_of(solid);
  const std::vector<int> of_lattice = parts_of_lattice(solid, lattice);
  std::map<int, std::vector<int>> together;  // parts of the mesh, by part of the lattice
  for (const int v : solid.face_vertices) {
    std::vector<int>& known = together[of_lattice[at(v)]];
    if (const int part = parts[at(v)]; known.empty() || known.back() != part) known.push_back(part);
  }
  std::vector<int> solids;
  for (auto& [place, known] : together) {
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    if (known.size() < 2) continue;
    if (solids.empty()) solids = solids_of(solid);
    for (int& part : known) part = solids[at(part)];
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    if (known.size() < 2) continue;
    SharedVoxels shared{known.size(), {}, std::numeric_limits<double>::infinity()};
    std::vector<Vec3i> triangles;
    for (const Vec3i& t : triangulate(solid).triangles)
      if (solids[at(t[0])] == known.front()) triangles.push_back(t);
    const ClosestPointQuery surface(solid.positions, triangles);
    for (const int v : solid.face_vertices) {
      if (solids[at(v)] == known.front() || of_lattice[at(v)] != place) continue;
      const ClosestPoint nearest = surface(solid.positions[at(v)]);
      if (nearest.distance >= shared.distance) continue;
      shared.distance = nearest.distance;
      shared.vertices = {triangles[at(nearest.triangle)][0], v};
    }
    return shared;
  }
  return std::nullopt;
}

}  // namespace muslin
