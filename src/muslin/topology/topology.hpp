// Topology describes how the faces of a surface are joined: the vertices of each face and the edges they
// share.
//
// It is a value. A change, such as a cut, makes a new topology with a higher version; derived data (edges,
// hinges, contact surfaces) is rebuilt by the functions that built it before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

struct MUSLIN_API Topology {
  std::vector<int> face_offsets;   ///< #F + 1; face f has corners face_offsets[f] … face_offsets[f+1]−1
  std::vector<int> face_vertices;  ///< #C vertex of each corner
  std::int64_t version = 0;        ///< number of changes since the surface was made

  std::size_t face_count() const { return face_offsets.empty() ? 0 : face_offsets.size() - 1; }
  std::span<const int> face(std::size_t f) const {
    return {face_vertices.data() + face_offsets[f],
            static_cast<std::size_t>(face_offsets[f + 1] - face_offsets[f])};
  }
  /// Returns the corner that follows corner c around face f.
  int next_corner(int f, int c) const {
    return c + 1 < face_offsets[static_cast<std::size_t>(f) + 1] ? c + 1
                                                                 : face_offsets[static_cast<std::size_t>(f)];
  }
};

/// One side of one face.
struct EdgeUse {
  int low = 0, high = 0;  ///< the edge's vertices, low ≤ high
  int face = 0;
  int corner = 0;        ///< index of the corner where the side starts
  bool ascends = false;  ///< the face runs from low to high
};

/// Returns the sides of all faces, sorted by edge, then face, then corner. Sides from a vertex to itself are
/// left out.
MUSLIN_API std::vector<EdgeUse> edge_uses(const Topology& topology);

/// Returns the sides of triangles: the side that starts at corner c of triangle t has corner index 3 t + c.
std::vector<EdgeUse> triangle_sides(std::span<const Vec3i> triangles);

/// Calls visit(uses of one edge) for each edge of sorted `uses`.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].low == uses[begin].low && uses[end].high == uses[begin].high) ++end;
    visit(uses.subspan(begin, end - begin));
  }
}

/// A changed topology, and for each of its vertices the vertex of the earlier topology it comes from.
struct TopologyChange {
  Topology topology;
  std::vector<int> origins;  ///< #V of the new topology
};

/// Opens edges, given by their two vertices: faces on both sides no longer share them. Around a vertex of
/// these edges, the faces fall into groups that other edges still join. The group with the lowest face keeps
/// the vertex; every other group gets a new vertex, numbered from `vertex_count` on. An edge stays closed if
/// neither of its vertices is split. Errors: usage, for a pair of vertices that is not an edge.
MUSLIN_API TopologyChange cut(const Topology& topology, std::size_t vertex_count,
                              std::span<const std::array<int, 2>> edges);

}  // namespace muslin
