#include "muslin/untangle/piercings.hpp"

#include <algorithm>
#include <optional>

#include "muslin/contact/exact_predicates.hpp"
#include "muslin/core/index.hpp"

namespace muslin {
namespace {

std::optional<Piercing> pierce(const ContactSurface& surface, ConstVectors x, int edge, int triangle) {
  const ContactSurface::Edge& e = surface.edges()[at(edge)];
  const Vec3i& t = surface.triangles()[at(triangle)];
  for (int i = 0; i < 3; ++i)
    if (t[i] == e[0] || t[i] == e[1]) return std::nullopt;
  const Vec3 &p = x[at(e[0])], &q = x[at(e[1])], &a = x[at(t[0])], &b = x[at(t[1])], &c = x[at(t[2])];
  if (orientation(a, b, c, p) * orientation(a, b, c, q) >= 0) return std::nullopt;
  const int side = orientation(p, q, a, b);
  if (side == 0 || orientation(p, q, b, c) != side || orientation(p, q, c, a) != side) return std::nullopt;
  // Signed volumes, whose shares are the weights.
  const auto volume = [&](const Vec3& u, const Vec3& v) { return std::abs((q - p).cross(u - p).dot(v - p)); };
  const Vec3 normal = (b - a).cross(c - a);
  const double above = std::abs(normal.dot(p - a)), below = std::abs(normal.dot(q - a));
  Vec3 weights(volume(b, c), volume(c, a), volume(a, b));
  Piercing result;
  result.edge = edge;
  result.triangle = triangle;
  result.along = above + below > 0 ? above / (above + below) : 0.5;
  result.barycentric = weights.sum() > 0 ? Vec3(weights / weights.sum()) : Vec3(Vec3::Constant(1.0 / 3));
  result.at = p + result.along * (q - p);
  return result;
}

}  // namespace

std::vector<Piercing> find_piercings(const ContactSurface& surface, ConstVectors x,
                                     std::span<const std::array<int, 2>> crossing) {
  std::vector<std::array<int, 2>> tested;  // edge, triangle
  tested.reserve(6 * crossing.size());
  for (const auto& [first, second] : crossing) {
    for (int i = 0; i < 3; ++i) {
      const int e = surface.triangle_edges()[at(first)][i], f = surface.triangle_edges()[at(second)][i];
      if (e >= 0) tested.push_back({e, second});
      if (f >= 0) tested.push_back({f, first});
    }
  }
  std::sort(tested.begin(), tested.end());
  tested.erase(std::unique(tested.begin(), tested.end()), tested.end());
  std::vector<Piercing> found;
  for (const auto& [edge, triangle] : tested)
    if (const std::optional<Piercing> p = pierce(surface, x, edge, triangle)) found.push_back(*p);
  return found;
}

}  // namespace muslin
