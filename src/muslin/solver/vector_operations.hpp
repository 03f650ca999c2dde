// Provides sums and updates of #V by 3 vectors with the same bits for any thread count.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

inline constexpr std::size_t vector_grain = 4096;

/// body(v) for all v.
template <class Body>
void for_each_vertex(std::size_t count, const Body& body) {
  parallel_for(count, vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) body(v);
  });
}

inline void set_zero(Vectors y) {
  parallel_for(y.size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    std::fill(y.begin() + static_cast<std::ptrdiff_t>(begin), y.begin() + static_cast<std::ptrdiff_t>(end),
              Vec3::Zero());
  });
}

inline double dot(ConstVectors a, ConstVectors b) {
  return parallel_sum(a.size(), vector_grain, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t v = begin; v < end; ++v) sum += a[v].dot(b[v]);
    return sum;
  });
}

/// y += t x
inline void add(double t, ConstVectors x, Vectors y) {
  parallel_for(x.size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) y[v] += t * x[v];
  });
}

/// z = x + t y
inline void combine(ConstVectors x, double t, ConstVectors y, Vectors z) {
  parallel_for(x.size(), vector_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) z[v] = x[v] + t * y[v];
  });
}

inline bool all_finite(ConstVectors x) { return std::isfinite(dot(x, x)); }

}  // namespace muslin
