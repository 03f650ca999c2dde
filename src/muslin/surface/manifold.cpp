#include "muslin/surface/manifold.hpp"

#include <algorithm>
#include <cassert>
#include <span>

#include <tbb/parallel_sort.h>

#include "muslin/core/disjoint_sets.hpp"

namespace muslin {
namespace {

/// A side of a triangle; side 3·t + c runs from corner c of triangle t to the next.
struct Side {
  std::uint64_t edge;  ///< both vertices, the lower one in the upper half
  std::int64_t part;
  int side;
  bool ascends;
};

int next_corner(int side) { return side % 3 == 2 ? side - 2 : side + 1; }

std::vector<Side> sorted_sides(const std::vector<PartTriangle>& triangles) {
  std::vector<Side> sides(3 * triangles.size());
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const auto& triangle = triangles[s / 3];
    const auto a = static_cast<std::uint64_t>(triangle.vertices[s % 3]);
    const auto b = static_cast<std::uint64_t>(triangle.vertices[(s + 1) % 3]);
    sides[s] = {std::min(a, b) << 32 | std::max(a, b), triangle.part, static_cast<int>(s), a < b};
  }
  tbb::parallel_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.side < b.side;
  });
  return sides;
}

/// Pairs the sides of one edge, each with one that runs the other way: first those of one part, then those
/// of one cell, then the rest.
template <class Visit>
void pair_sides(std::span<const Side> group, const Visit& visit) {
  std::vector<char> paired(group.size(), 0);
  for (int round = group.size() == 2 ? 2 : 0; round < 3; ++round) {
    for (std::size_t a = 0; a < group.size(); ++a) {
      for (std::size_t b = a + 1; b < group.size() && !paired[a]; ++b) {
        if (paired[b] || group[a].ascends == group[b].ascends) continue;
        if (round == 0 && group[a].part != group[b].part) continue;
        if (round == 1 && group[a].part / 8 != group[b].part / 8) continue;
        paired[a] = paired[b] = 1;
        visit(group[a].side, group[b].side);
      }
    }
  }
  assert(std::all_of(paired.begin(), paired.end(), [](char p) { return p != 0; }));
}

/// Cuts a triangle at the middles of its sides (−1 for a side that stays whole).
void cut(const std::array<int, 3>& corners, const std::array<int, 3>& middles, std::vector<Vec3i>& out) {
  std::vector<int> outline;
  for (int c = 0; c < 3; ++c) {
    outline.push_back(corners[c]);
    if (middles[c] >= 0) outline.push_back(middles[c]);
  }
  // Ears at the corners between two middles first, then a fan from a middle: no triangle is flat.
  if (outline.size() == 6) {
    for (int c = 0; c < 3; ++c) out.push_back({corners[c], middles[c], middles[(c + 2) % 3]});
    out.push_back({middles[0], middles[1], middles[2]});
    return;
  }
  std::size_t apex = 0;
  while (apex < outline.size() &&
         (outline[apex] == corners[0] || outline[apex] == corners[1] || outline[apex] == corners[2]))
    ++apex;
  const std::size_t n = outline.size();
  if (apex == n) apex = 0;
  for (std::size_t d = 1; d + 1 < n; ++d)
    out.push_back({outline[apex], outline[(apex + d) % n], outline[(apex + d + 1) % n]});
}

}  // namespace

Manifold make_manifold(const std::vector<PartTriangle>& triangles) {
  const std::vector<Side> sides = sorted_sides(triangles);
  DisjointSets corners(sides.size());
  std::vector<std::array<int, 2>> crowded;  // pairs of sides of edges that have several
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    const std::span<const Side> group(sides.data() + begin, end - begin);
    pair_sides(group, [&](int a, int b) {
      corners.join(a, next_corner(b));
      corners.join(next_corner(a), b);
      if (group.size() > 2) crowded.push_back({a, b});
    });
  }

  Manifold manifold;
  std::vector<int> number(sides.size(), -1);
  std::vector<int> vertex_of(sides.size());
  for (std::size_t s = 0; s < sides.size(); ++s) {
    int& vertex = number[corners.find(static_cast<int>(s))];
    if (vertex < 0) {
      vertex = static_cast<int>(manifold.sources.size());
      const int source = triangles[s / 3].vertices[s % 3];
      manifold.sources.push_back({source, source});
    }
    vertex_of[s] = vertex;
  }

  // Two sheets may still share both ends of an edge: they are separated by a vertex in its middle.
  std::vector<int> middle(sides.size(), -1);
  const auto ends = [&](const std::array<int, 2>& pair) {
    return std::minmax({vertex_of[pair[0]], vertex_of[next_corner(pair[0])]});
  };
  std::sort(crowded.begin(), crowded.end(),
            [&](const auto& a, const auto& b) { return std::pair(ends(a), a) < std::pair(ends(b), b); });
  for (std::size_t p = 1; p < crowded.size(); ++p) {
    if (ends(crowded[p]) != ends(crowded[p - 1])) continue;
    const int a = crowded[p][0], b = crowded[p][1];
    middle[a] = middle[b] = static_cast<int>(manifold.sources.size());
    manifold.sources.push_back({triangles[a / 3].vertices[a % 3], triangles[b / 3].vertices[b % 3]});
  }

  manifold.triangles.reserve(triangles.size());
  for (std::size_t s = 0; s < sides.size(); s += 3) {
    cut({vertex_of[s], vertex_of[s + 1], vertex_of[s + 2]}, {middle[s], middle[s + 1], middle[s + 2]},
        manifold.triangles);
  }
  return manifold;
}

}  // namespace muslin
