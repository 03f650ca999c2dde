#include "muslin/surface/contour.hpp"

#include <algorithm>
#include <cassert>

#include "muslin/core/parallel.hpp"
#include "muslin/geometry/closest_point.hpp"
#include "muslin/surface/manifold.hpp"
#include "muslin/surface/marching.hpp"

namespace muslin {
namespace {

constexpr std::size_t contour_grain = 1024;

/// Returns the mean of two carried points.
void carry_mean(const Embedding& from, int a, int b, Embedding& to, std::size_t at) {
  if (a == b) {
    to.vertices[at] = from.vertices[a];
    to.weights[at] = from.weights[a];
    return;
  }
  std::size_t used = 0;
  to.vertices[at].fill(from.vertices[a][0]);
  to.weights[at].fill(0);
  for (const int source : {a, b}) {
    for (std::size_t c = 0; c < 8; ++c) {
      if (from.weights[source][c] == 0) continue;
      assert(used < 8);
      to.vertices[at][used] = from.vertices[source][c];
      to.weights[at][used++] = 0.5 * from.weights[source][c];
    }
  }
}

/// Returns the largest value(i), 0 ≤ i < count.
template <class Value>
double largest(std::size_t count, const Value& value) {
  std::vector<double> partial((count + contour_grain - 1) / contour_grain, 0);
  parallel_for(count, contour_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      partial[begin / contour_grain] = std::max(partial[begin / contour_grain], value(i));
  });
  return partial.empty() ? 0 : *std::max_element(partial.begin(), partial.end());
}

double distance_between(const Mesh& contour, const std::vector<Vec3i>& triangles, const Mesh& solid,
                        const SignedDistance& distance) {
  if (triangles.empty()) return solid.bounds().diagonal().norm();
  const ClosestPointQuery closest(contour.positions, triangles);
  std::vector<char> used(solid.vertex_count(), 0);
  for (const int v : solid.face_vertices) used[v] = 1;
  return std::max({largest(contour.vertex_count(),
                           [&](std::size_t v) { return distance.distance(contour.positions[v]); }),
                   largest(triangles.size(),
                           [&](std::size_t t) {
                             const Vec3 centre =
                                 (contour.positions[triangles[t][0]] + contour.positions[triangles[t][1]] +
                                  contour.positions[triangles[t][2]]) /
                                 3;
                             return distance.distance(centre);
                           }),
                   largest(solid.vertex_count(), [&](std::size_t v) {
                     return used[v] ? closest(solid.positions[v]).distance : 0;
                   })});
}

}  // namespace

Contour build_contour(const Lattice& lattice, const Mesh& solid, const SignedDistance& distance,
                      ContourMethod method) {
  const MarchedSurface surface =
      method == ContourMethod::cubes ? march_cubes(lattice, distance) : march_squares(lattice, distance);
  const Manifold manifold = make_manifold(surface.triangles);

  Contour contour;
  contour.method = method;
  const std::size_t count = manifold.sources.size();
  contour.mesh.positions.resize(count);
  contour.embedding.vertices.resize(count);
  contour.embedding.weights.resize(count);
  parallel_for(count, contour_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto& [a, b] = manifold.sources[v];
      contour.mesh.positions[v] =
          a == b ? surface.positions[a] : 0.5 * (surface.positions[a] + surface.positions[b]);
      carry_mean(surface.embedding, a, b, contour.embedding, v);
    }
  });
  contour.embedding.prepare_transpose(lattice.vertex_count());
  for (const Vec3i& triangle : manifold.triangles)
    contour.mesh.add_face(std::array{triangle[0], triangle[1], triangle[2]});
  contour.distance = distance_between(contour.mesh, manifold.triangles, solid, distance);
  return contour;
}

}  // namespace muslin
