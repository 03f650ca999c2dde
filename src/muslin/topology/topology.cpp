#include "muslin/topology/topology.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/disjoint_sets.hpp"
#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using VertexPair = std::pair<int, int>;

/// Sorts the edges to open, each once with its lower vertex first.
std::vector<VertexPair> sorted_pairs(std::span<const std::array<int, 2>> edges) {
  std::vector<VertexPair> pairs;
  pairs.reserve(edges.size());
  for (const auto& [a, b] : edges) pairs.emplace_back(std::min(a, b), std::max(a, b));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace

std::vector<EdgeUse> edge_uses(const Topology& topology) {
  std::vector<EdgeUse> uses;
  uses.reserve(topology.face_vertices.size());
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    const int begin = topology.face_offsets[f], end = topology.face_offsets[f + 1];
    for (int c = begin; c < end; ++c) {
      const int from = topology.face_vertices[static_cast<std::size_t>(c)];
      const int to = topology.face_vertices[static_cast<std::size_t>(c + 1 < end ? c + 1 : begin)];
      if (from == to) continue;
      uses.push_back({std::min(from, to), std::max(from, to), static_cast<int>(f), c, from < to});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.face, a.corner) < std::tie(b.low, b.high, b.face, b.corner);
  });
  return uses;
}

std::vector<EdgeUse> triangle_sides(std::span<const Vec3i> triangles) {
  Topology topology;
  topology.face_offsets.resize(triangles.size() + 1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    topology.face_offsets[t + 1] = static_cast<int>(3 * (t + 1));
    for (const int v : triangles[t]) topology.face_vertices.push_back(v);
  }
  return edge_uses(topology);
}

TopologyChange cut(const Topology& topology, std::size_t vertex_count,
                   std::span<const std::array<int, 2>> edges) {
  const std::vector<VertexPair> opened = sorted_pairs(edges);
  std::vector<bool> parts(vertex_count, false);  // vertices that may part
  DisjointSets corners(topology.face_vertices.size());
  std::size_t found = 0;
  const std::vector<EdgeUse> uses = edge_uses(topology);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (std::binary_search(opened.begin(), opened.end(), VertexPair{edge[0].low, edge[0].high})) {
      ++found;
      parts[static_cast<std::size_t>(edge[0].low)] = parts[static_cast<std::size_t>(edge[0].high)] = true;
      return;
    }
    const auto corner_at = [&](const EdgeUse& use, bool low) {
      return use.ascends == low ? use.corner : topology.next_corner(use.face, use.corner);
    };
    for (const EdgeUse& use : edge.subspan(1)) {
      corners.join(corner_at(edge[0], true), corner_at(use, true));
      corners.join(corner_at(edge[0], false), corner_at(use, false));
    }
  });
  if (found != opened.size()) {
    for (const auto& [low, high] : opened) {
      const bool is_edge = std::any_of(
          uses.begin(), uses.end(),
          [low = low, high = high](const EdgeUse& use) { return use.low == low && use.high == high; });
      if (!is_edge)
        throw Error(ErrorKind::usage,
                    fmt::format("vertices {} and {} share no edge that could be cut", low, high),
                    "give pairs of vertices that are neighbours along a face, counted from 0");
    }
  }

  TopologyChange change{topology, std::vector<int>(vertex_count)};
  std::iota(change.origins.begin(), change.origins.end(), 0);
  ++change.topology.version;
  std::vector<int> kept(vertex_count, -1);                         // the set of corners that keeps a vertex
  std::vector<int> new_vertex(topology.face_vertices.size(), -1);  // by set
  for (std::size_t c = 0; c < topology.face_vertices.size(); ++c) {
    const auto v = static_cast<std::size_t>(topology.face_vertices[c]);
    if (!parts[v]) continue;
    const int set = corners.find(static_cast<int>(c));
    if (kept[v] < 0) kept[v] = set;
    if (kept[v] == set) continue;
    int& vertex = new_vertex[static_cast<std::size_t>(set)];
    if (vertex < 0) {
      vertex = static_cast<int>(change.origins.size());
      change.origins.push_back(static_cast<int>(v));
    }
    change.topology.face_vertices[c] = vertex;
  }
  return change;
}

}  // namespace muslin
