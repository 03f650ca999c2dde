#include "muslin/shell/inverted_triangles.hpp"

#include <cmath>

#include "muslin/core/disjoint_sets.hpp"
#include "muslin/shell/shell.hpp"
#include "muslin/topology/topology.hpp"

namespace muslin {
namespace {

constexpr double flat_fold = 3;  // from this angle on, of at most π, two triangles lie upon each other
constexpr int largest_part = 4;  // triangles

}  // namespace

std::vector<int> inverted_triangles(std::span<const Vec3i> triangles, ConstVectors rest) {
  const auto at = [&](int v) { return rest[static_cast<std::size_t>(v)]; };
  DisjointSets parts(triangles.size());
  std::vector<std::uint8_t> enclosed(triangles.size(), 1);
  for_each_edge(triangle_sides(triangles), [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2) {
      for (const EdgeUse& use : edge) enclosed[static_cast<std::size_t>(use.face)] = 0;
      return;
    }
    const auto opposite = [&](const EdgeUse& use) {
      return at(triangles[static_cast<std::size_t>(use.face)][(use.corner + 2) % 3]);
    };
    const double angle = hinge_angle(at(edge[0].low), at(edge[0].high), opposite(edge[0]), opposite(edge[1]));
    if (std::abs(angle) < flat_fold) parts.join(edge[0].face, edge[1].face);
  });
  const std::vector<int> part = parts.find_all();
  std::vector<int> sizes(triangles.size(), 0);
  std::vector<std::uint8_t> closed(triangles.size(), 1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    ++sizes[static_cast<std::size_t>(part[t])];
    if (enclosed[t] == 0) closed[static_cast<std::size_t>(part[t])] = 0;
  }
  std::vector<int> inverted;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto p = static_cast<std::size_t>(part[t]);
    if (closed[p] != 0 && sizes[p] <= largest_part && sizes[p] < static_cast<int>(triangles.size()))
      inverted.push_back(static_cast<int>(t));
  }
  return inverted;
}

}  // namespace muslin
