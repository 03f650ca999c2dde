#include "muslin/untangle/surface_pieces.hpp"

#include <algorithm>

#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/index.hpp"

namespace muslin {
namespace {

/// True if triangles pass the edge as often in one direction as in the other.
bool is_balanced(const ContactSurface& surface, int e) {
  const ContactSurface::Edge& edge = surface.edges()[at(e)];
  int sum = 0;
  for (const int side : surface.triangles_at_edge(e)) {
    const Vec3i& t = surface.triangles()[at(side)];
    bool forward = false;
    for (int i = 0; i < 3; ++i) forward = forward || (t[i] == edge[0] && t[(i + 1) % 3] == edge[1]);
    sum += forward ? 1 : -1;
  }
  return sum == 0;
}

}  // namespace

SurfacePieces::SurfacePieces(const ContactSurface& surface, ConstVectors rest)
    : of_point_(surface.point_count(), -1),
      of_triangle_(surface.triangles().size(), -1),
      areas_(surface.point_count(), 0.0) {
  const std::span<const Vec3i> triangles = surface.triangles();
  DisjointSets sets(surface.point_count());
  for (const Vec3i& t : triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<int> of_root(surface.point_count(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    int& piece = of_root[at(sets.find(triangles[t][0]))];
    if (piece < 0) {
      piece = count();
      pieces_.emplace_back();
      pieces_.back().body = surface.body_of(triangles[t][0]);
      pieces_.back().solid = surface.bodies()[at(pieces_.back().body)].solid;
    }
    of_triangle_[t] = piece;
    pieces_[at(piece)].triangles.push_back(static_cast<int>(t));
    const Vec3 &a = rest[at(triangles[t][0])], &b = rest[at(triangles[t][1])], &c = rest[at(triangles[t][2])];
    const double area = (b - a).cross(c - a).norm() / 2;
    for (int i = 0; i < 3; ++i) areas_[at(triangles[t][i])] += area / 3;
  }
  for (int p = 0; p < static_cast<int>(surface.point_count()); ++p) {
    const int piece = of_root[at(sets.find(p))];
    of_point_[at(p)] = piece;
    if (piece >= 0) pieces_[at(piece)].points.push_back(p);
  }
  for (int e = 0; e < static_cast<int>(surface.edges().size()); ++e) {
    if (!is_balanced(surface, e)) pieces_[at(of_point(surface.edges()[at(e)][0]))].solid = false;
  }
}

}  // namespace muslin
