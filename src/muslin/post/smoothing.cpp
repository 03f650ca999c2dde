#include "muslin/post/smoothing.hpp"

#include <array>
#include <utility>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

// A pair of factors of Taubin's filter: 1/inward + 1/outward = 0.01, the wave number that passes unchanged.
// At half of it waves grow the most, by 6e-6 in a round.
constexpr double inward = 0.5;
constexpr double outward = -0.5 / 0.995;
/// Cosine of the angle by which the border turns at a corner.
constexpr double corner_cosine = 0.7071;

}  // namespace

Smoothing::Smoothing(const Mesh& mesh, int rounds) : rounds_(rounds) {
  const std::size_t vertex_count = mesh.vertex_count();
  const std::vector<EdgeUse> uses = edge_uses(mesh);
  std::vector<std::array<int, 2>> inner, crease;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    (edge.size() == 2 ? inner : crease).push_back({edge[0].low, edge[0].high});
  });
  std::vector<int> creases(vertex_count, 0);
  for (const auto& edge : crease)
    for (const int v : edge) ++creases[at(v)];
  std::vector<std::vector<int>> neighbours(vertex_count);
  const auto join = [&](const std::array<int, 2>& edge, bool on_crease) {
    for (const auto& [v, other] : {std::pair(edge[0], edge[1]), std::pair(edge[1], edge[0])})
      if (creases[at(v)] == (on_crease ? 2 : 0)) neighbours[at(v)].push_back(other);
  };
  for (const auto& edge : inner) join(edge, false);
  for (const auto& edge : crease) join(edge, true);
  for (std::size_t v = 0; v < vertex_count; ++v) {
    if (creases[v] != 2) continue;
    const Vec3 before = mesh.positions[v] - mesh.positions[at(neighbours[v][0])];
    const Vec3 after = mesh.positions[at(neighbours[v][1])] - mesh.positions[v];
    if (before.dot(after) < corner_cosine * before.norm() * after.norm()) neighbours[v].clear();
  }
  offsets_.assign(1, 0);
  offsets_.reserve(vertex_count + 1);
  for (const auto& of_vertex : neighbours) {
    neighbours_.insert(neighbours_.end(), of_vertex.begin(), of_vertex.end());
    offsets_.push_back(static_cast<int>(neighbours_.size()));
  }
}

std::vector<Vec3> Smoothing::points(ConstVectors positions) const {
  std::vector<Vec3> from(positions.begin(), positions.end()), to(positions.size());
  for (int step = 0; step < 2 * rounds_; ++step) {
    const double factor = step % 2 == 0 ? inward : outward;
    parallel_for(from.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const int first = offsets_[v], last = offsets_[v + 1];
        Vec3 pull = Vec3::Zero();
        for (int n = first; n < last; ++n) pull += from[at(neighbours_[at(n)])] - from[v];
        to[v] = last > first ? Vec3(from[v] + factor / (last - first) * pull) : from[v];
      }
    });
    from.swap(to);
  }
  return from;
}

}  // namespace muslin
