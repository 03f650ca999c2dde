#include "muslin/component/lattice/solids.hpp"

#include <cmath>
#include <map>
#include <optional>

#include "muslin/contact/intersections.hpp"
#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/index.hpp"
#include "muslin/geometry/winding_number.hpp"

namespace muslin {
namespace {

DisjointSets connected(const Mesh& mesh) {
  DisjointSets parts(mesh.vertex_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    for (const int v : mesh.face(f)) parts.join(mesh.face(f)[0], v);
  return parts;
}

/// Joins parts of the mesh that are one solid.
class Solids {
 public:
  explicit Solids(const Mesh& mesh)
      : mesh_(mesh), triangles_(triangulate(mesh).triangles), sets_(connected(mesh)) {
    part_ = sets_.find_all();
    join_crossing();
    join_contained();
  }

  std::vector<int> find_all() { return sets_.find_all(); }

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
        if (inner == outer || !boxes.at(outer).contains(box) || sets_.find(inner) == sets_.find(outer))
          continue;
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

std::vector<int> parts_of(const Mesh& mesh) { return connected(mesh).find_all(); }

std::vector<int> solids_of(const Mesh& mesh) { return Solids(mesh).find_all(); }

}  // namespace muslin
