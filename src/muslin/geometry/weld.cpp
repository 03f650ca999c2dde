#include "muslin/geometry/weld.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"

namespace muslin {
namespace {

constexpr double near_share = 0.01;  // of the mean edge

/// Points sorted into cubes as wide as the distance within which they are searched.
class Cubes {
 public:
  Cubes(ConstVectors positions, const std::vector<int>& points, double reach)
      : positions_(positions), reach_(reach) {
    Box box;
    for (const int v : points) box.extend(positions[at(v)]);
    const double size = points.empty() ? 1 : box.diagonal().norm();
    width_ = std::max({reach, 1e-9 * size, std::numeric_limits<double>::min()});
    for (const int v : points) entries_.push_back({cube_of(positions[at(v)]), v});
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls visit(w, distance) for the points within reach of point v, except itself.
  template <class Visit>
  void for_near(int v, const Visit& visit) const {
    const Vec3& x = positions_[at(v)];
    const Cube middle = cube_of(x);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j) {
        // Cubes along z follow each other.
        const Cube first = {middle[0] + i, middle[1] + j, middle[2] - 1};
        const Cube last = {first[0], first[1], middle[2] + 1};
        for (auto e = std::lower_bound(entries_.begin(), entries_.end(), Entry{first, 0});
             e != entries_.end() && e->cube <= last; ++e) {
          const double distance = (positions_[at(e->point)] - x).norm();
          if (e->point != v && distance <= reach_) visit(e->point, distance);
        }
      }
  }

 private:
  using Cube = std::array<std::int64_t, 3>;
  struct Entry {
    Cube cube;
    int point;
    auto operator<=>(const Entry&) const = default;
  };

  Cube cube_of(const Vec3& x) const {
    const auto along = [&](int axis) { return static_cast<std::int64_t>(std::floor(x[axis] / width_)); };
    return {along(0), along(1), along(2)};
  }

  ConstVectors positions_;
  double reach_, width_;
  std::vector<Entry> entries_;
};

std::vector<int> used_vertices(const Mesh& mesh) {
  std::vector<std::uint8_t> used(mesh.vertex_count(), 0);
  for (const int v : mesh.face_vertices) used[at(v)] = 1;
  std::vector<int> vertices;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) vertices.push_back(static_cast<int>(v));
  return vertices;
}

/// `first`, by original vertex: the first of those with which it is joined; −1 if it is left out.
ReducedMesh reduced(const Mesh& mesh, const std::vector<int>& first) {
  ReducedMesh result{mesh, std::vector<int>(first.size(), -1), {}};
  result.mesh.positions.clear();
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (first[v] < 0) continue;
    if (at(first[v]) == v) {
      result.vertices[v] = static_cast<int>(result.origins.size());
      result.origins.push_back(static_cast<int>(v));
      result.mesh.positions.push_back(mesh.positions[v]);
    } else {
      result.vertices[v] = result.vertices[at(first[v])];
    }
  }
  for (int& v : result.mesh.face_vertices) v = result.vertices[at(v)];
  for (MeshGroup& group : result.mesh.groups) {
    for (int& v : group.vertices) v = result.vertices[at(v)];
    std::sort(group.vertices.begin(), group.vertices.end());
    group.vertices.erase(std::unique(group.vertices.begin(), group.vertices.end()), group.vertices.end());
    if (!group.vertices.empty() && group.vertices.front() < 0) group.vertices.erase(group.vertices.begin());
  }
  return result;
}

/// Refuses polygons that have lost a corner.
void require_corners(const Mesh& mesh, const ReducedMesh& welded, double tolerance) {
  std::vector<int> corners;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = welded.mesh.face(f);
    corners.assign(face.begin(), face.end());
    std::sort(corners.begin(), corners.end());
    const auto twice = std::adjacent_find(corners.begin(), corners.end());
    if (twice == corners.end()) continue;
    const auto original = mesh.face(f);
    const auto place = [&](std::ptrdiff_t from) {
      return std::find(face.begin() + from, face.end(), *twice) - face.begin();
    };
    const auto a = place(0), b = place(a + 1);
    throw Error(ErrorKind::input,
                fmt::format("a weld of {} m joins vertices {} and {} of polygon {}", tolerance,
                            original[at(a)] + 1, original[at(b)] + 1, f + 1),
                "give a smaller `weld`, or dissolve the polygon in the modeller");
  }
}

}  // namespace

ReducedMesh weld(const Mesh& mesh, double tolerance) {
  const std::vector<int> used = used_vertices(mesh);
  const Cubes cubes(mesh.positions, used, tolerance);
  DisjointSets sets(mesh.vertex_count());
  for (const int v : used) cubes.for_near(v, [&](int w, double) { sets.join(v, w); });
  std::vector<int> first(mesh.vertex_count(), -1);
  for (const int v : used) first[at(v)] = sets.find(v);
  ReducedMesh welded = reduced(mesh, first);
  require_corners(mesh, welded, tolerance);
  return welded;
}

ReducedMesh without_loose_vertices(const Mesh& mesh) {
  std::vector<int> first(mesh.vertex_count(), -1);
  for (const int v : used_vertices(mesh)) first[at(v)] = v;
  return reduced(mesh, first);
}

NearBorders near_borders(const Mesh& mesh) {
  const std::vector<EdgeUse> uses = edge_uses(mesh);
  double length = 0;
  std::vector<std::array<int, 2>> open;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() > 1) return;
    open.push_back({edge[0].low, edge[0].high});
    length += (mesh.positions[at(edge[0].high)] - mesh.positions[at(edge[0].low)]).norm();
  });
  NearBorders found;
  if (open.empty()) return found;
  std::vector<int> border;
  for (const auto& edge : open) border.insert(border.end(), edge.begin(), edge.end());
  std::sort(border.begin(), border.end());
  border.erase(std::unique(border.begin(), border.end()), border.end());
  std::vector<std::array<int, 2>> edges;
  edges.reserve(uses.size());
  for (const EdgeUse& use : uses) edges.push_back({use.low, use.high});
  const Cubes cubes(mesh.positions, border, near_share * length / static_cast<double>(open.size()));
  for (const int v : border) {
    double least = std::numeric_limits<double>::infinity();
    cubes.for_near(v, [&](int w, double distance) {
      const auto [low, high] = std::minmax(v, w);
      if (!std::binary_search(edges.begin(), edges.end(), std::array{low, high}))
        least = std::min(least, distance);
    });
    if (!std::isfinite(least)) continue;
    ++found.vertices;
    found.distance = std::max(found.distance, least);
  }
  return found;
}

}  // namespace muslin
