#include "muslin/solver/spring_hessian_kernels.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int lanes = EliminationOrder::lanes;
constexpr std::size_t grain = 1024;  // blocks
constexpr float shortest = static_cast<float>(shortest_spring);

/// Coordinates by position.
struct Coordinates {
  const double *x = nullptr, *y = nullptr, *z = nullptr;
};

/// x in the order of the pattern, 0 where a position is empty.
Coordinates arrange(const EliminationOrder& pattern, ConstVectors x, std::span<float> workspace) {
  const std::size_t size = pattern.position_count();
  auto* const to = reinterpret_cast<double*>(workspace.data());
  const int* const vertices = pattern.vertices().data();
  constexpr std::size_t ahead = 64;
  parallel_for(size, 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // The order of the pattern jumps from row to row, which hardware prefetchers do not predict.
      const int v = vertices[i], next = vertices[std::min(i + ahead, end - 1)];
      if (next >= 0) __builtin_prefetch(x.data() + next);
      const Vec3 at = v < 0 ? Vec3(Vec3::Zero()) : x[static_cast<std::size_t>(v)];
      to[i] = at.x(), to[size + i] = at.y(), to[2 * size + i] = at.z();
    }
  });
  return {to, to + size, to + 2 * size};
}

/// Consecutive blocks and where their couplings are.
struct Batch {
  const EliminationOrder::Block* blocks = nullptr;
  std::size_t count = 0;
  const CentralSpring* kinds = nullptr;
  const float* weights = nullptr;
  Coordinates x;
  std::uint32_t* words = nullptr;
  float* units = nullptr;
};
struct Kernels {
  void (*spring_hessian_kernels)(const Batch& batch);
  void (*dashpot_couplings)(const Batch& batch);
};

namespace plain {
#include "muslin/solver/spring_hessian_kernels.inc"
}  // namespace plain
}  // namespace

#ifdef MUSLIN_BY_PROCESSOR
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v3")
namespace {
namespace avx2 {
#include "muslin/solver/spring_hessian_kernels.inc"
}  // namespace avx2
}  // namespace
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
namespace {
namespace avx512 {
#include "muslin/solver/spring_hessian_kernels.inc"
}  // namespace avx512
}  // namespace
#pragma GCC pop_options
#endif

namespace {

const Kernels& kernels() {
#ifdef MUSLIN_BY_PROCESSOR
  static const Kernels& best = __builtin_cpu_supports("x86-64-v4")   ? avx512::table
                               : __builtin_cpu_supports("x86-64-v3") ? avx2::table
                                                                     : plain::table;
  return best;
#else
  return plain::table;
#endif
}

template <class Kernel>
void for_each_batch(const BlockSprings& springs, SpringHessian& couplings, const Kernel& kernel) {
  const EliminationOrder& pattern = couplings.pattern();
  const Coordinates at = arrange(pattern, springs.x, springs.workspace);
  parallel_for(pattern.block_count(), grain, [&](std::size_t begin, std::size_t end) {
    Batch batch;
    batch.blocks = pattern.blocks().data() + begin;
    batch.count = end - begin;
    batch.kinds = springs.kinds.data();
    batch.weights = springs.weights != nullptr ? springs.weights + lanes * begin : nullptr;
    batch.x = at;
    batch.words = couplings.words(begin);
    batch.units = couplings.units(begin);
    kernel(batch);
  });
}

}  // namespace

void set_spring_hessian(const BlockSprings& springs, SpringHessian& couplings) {
  for_each_batch(springs, couplings, kernels().spring_hessian_kernels);
}

void add_dashpot_hessian(const BlockSprings& dashpots, SpringHessian& couplings) {
  for_each_batch(dashpots, couplings, kernels().dashpot_couplings);
}

}  // namespace muslin
