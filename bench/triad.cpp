#include "triad.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

#include "muslin/core/parallel.hpp"

namespace muslin::bench {
namespace {

void triad(double* __restrict a, const double* __restrict b, const double* __restrict c, double s,
           std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + s * c[i];
}

}  // namespace

double stream_triad() {
  constexpr std::size_t count = 20'000'000;
  std::vector<double> a(count, 1), b(count, 2), c(count, 3);
  double best = 0;
  for (int pass = 0; pass < 8; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    parallel_for(count, 1 << 18, [&](std::size_t begin, std::size_t end) {
      triad(a.data(), b.data(), c.data(), 0.5, begin, end);
    });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best = std::max(best, 24.0 * count / seconds);
  }
  return best;
}

}  // namespace muslin::bench
