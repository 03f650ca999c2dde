#include "muslin/surface/marching.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_sort.h>

#include "muslin/core/parallel.hpp"

namespace muslin {

double crossing(const SignedDistance& distance, const Vec3& inside, const Vec3& outside, double value_inside,
                double value_outside, int evaluations, double tolerance) {
  constexpr double margin = 1e-4;
  const double length = (outside - inside).norm();
  double a = 0, b = 1, fa = value_inside, fb = value_outside;
  if (fa >= 0) return margin;
  double t = fa / (fa - fb);
  int last = 0;  // which end moved
  for (int e = 0; e < evaluations && b - a > tolerance; ++e) {
    const double f = distance(inside + t * (outside - inside));
    if (std::abs(f) <= tolerance * length) break;
    // An end that stays twice counts half, so that the next step comes from the other side.
    const int moved = f < 0 ? -1 : 1;
    if (moved < 0) {
      a = t, fa = f;
      if (last == moved) fb *= 0.5;
    } else {
      b = t, fb = f;
      if (last == moved) fa *= 0.5;
    }
    last = moved;
    t = a + (b - a) * fa / (fa - fb);
  }
  return std::clamp(t, margin, 1 - margin);
}

std::vector<std::uint64_t> number_vertices(const std::vector<std::vector<NamedTriangle>>& blocks,
                                           std::vector<PartTriangle>& triangles) {
  std::vector<NamedTriangle> named;
  for (const auto& block : blocks) named.insert(named.end(), block.begin(), block.end());
  std::vector<std::uint64_t> names;
  names.reserve(3 * named.size());
  for (const NamedTriangle& triangle : named)
    names.insert(names.end(), triangle.names.begin(), triangle.names.end());
  tbb::parallel_sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  triangles.resize(named.size());
  parallel_for(named.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      triangles[t].part = named[t].part;
      for (int c = 0; c < 3; ++c) {
        triangles[t].vertices[c] =
            static_cast<int>(std::lower_bound(names.begin(), names.end(), named[t].names[c]) - names.begin());
      }
    }
  });
  return names;
}

}  // namespace muslin
