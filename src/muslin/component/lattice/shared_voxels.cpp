#include "muslin/component/lattice/shared_voxels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "muslin/contact/intersections.hpp"
#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/index.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/geometry/winding_number.hpp"
#include "muslin/lattice/embedding.hpp"

namespace muslin {
namespace {

/// Vertices connected by polygons, by the smallest of them.
DisjointSets parts_of(const Mesh& mesh) {
  DisjointSets parts(mesh.vertex_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    for (const int v : mesh.face(f)) parts.join(mesh.face(f)[0], v);
  return parts;
}

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

/// Joins parts of the mesh that are one solid.
class Solids {
 public:
  explicit Solids(const Mesh& mesh)
      : mesh_(mesh), triangles_(triangulate(mesh).triangles), sets_(parts_of(mesh)) {
    part_ = sets_.find_all();
    join_crossing();
    join_contained();
  }

  int find(int vertex) { return sets_.find(vertex); }
  /// Returns the triangles of the solid of a vertex.
  std::vector<Vec3i> triangles(int vertex) {
    std::vector<Vec3i> own;
    for (const Vec3i& t : triangles_)
      if (find(t[0]) == find(vertex)) own.push_back(t);
    return own;
  }

 private:
  void join_crossing() {
    const auto part = [&](int t) { return part_[at(triangles_[at(t)][0])]; };
    IntersectionOptions options;
    options.wanted = [&](int a, int b) { return part(a) != part(b); };
    for (const Intersection& crossing : find_intersections(mesh_.positions, triangles_, options))
      sets_.join(part(crossing.first), part(crossing.second));
  }

  void join_contained() {
    std::map<int, std::vector<Vec3i>> own;
    std::map<int, Box> boxes;
    for (const Vec3i& t : triangles_) {
      own[part_[at(t[0])]].push_back(t);
      for (const int v : t) boxes[part_[at(t[0])]].extend(mesh_.positions[at(v)]);
    }
    for (const auto& [outer, triangles] : own) {
      std::optional<WindingNumber> winding;
      for (const auto& [inner, box] : boxes) {
        if (inner == outer || !boxes.at(outer).contains(box) || find(inner) == find(outer)) continue;
        if (!winding) winding.emplace(mesh_.positions, triangles);
        if (std::abs((*winding)(mesh_.positions[at(inner)])) > 0.5) sets_.join(inner, outer);
      }
    }
  }

  const Mesh& mesh_;
  std::vector<Vec3i> triangles_;
  DisjointSets sets_;
  std::vector<int> part_;  // by vertex
};

}  // namespace

std::optional<SharedVoxels> find_shared_voxels(const Mesh& solid, const Lattice& lattice) {
  DisjointSets parts = parts_of(solid);
  const std::vector<int> of_lattice = parts_of_lattice(solid, lattice);
  std::map<int, std::vector<int>> together;  // parts of the mesh, by part of the lattice
  for (const int v : solid.face_vertices) {
    std::vector<int>& known = together[of_lattice[at(v)]];
    if (const int part = parts.find(v); known.empty() || known.back() != part) known.push_back(part);
  }
  std::optional<Solids> solids;
  for (auto& [place, known] : together) {
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    if (known.size() < 2) continue;
    if (!solids) solids.emplace(solid);
    for (int& part : known) part = solids->find(part);
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    if (known.size() < 2) continue;
    SharedVoxels shared{known.size(), {}, std::numeric_limits<double>::infinity()};
    const std::vector<Vec3i> triangles = solids->triangles(known.front());
    const ClosestPointQuery surface(solid.positions, triangles);
    for (const int v : solid.face_vertices) {
      if (solids->find(v) == known.front() || of_lattice[at(v)] != place) continue;
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
