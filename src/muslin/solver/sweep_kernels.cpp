#include "muslin/solver/sweep_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "muslin/core/vector_code.hpp"

namespace muslin::sweep_kernels {

namespace {
namespace plain {
#include "muslin/solver/sweep_kernels.inc"
}  // namespace plain
}  // namespace

// Vector types, unlike loops, use the instruction set of their scope: hence no function clones.
#ifdef MUSLIN_BY_PROCESSOR
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v3")
namespace {
namespace avx2 {
#include "muslin/solver/sweep_kernels.inc"
}  // namespace avx2
}  // namespace
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
namespace {
namespace avx512 {
#include "muslin/solver/sweep_kernels.inc"
}  // namespace avx512
}  // namespace
#pragma GCC pop_options
#endif

std::span<const Kernels* const> all_kernels(Couplings kind) {
  static const std::array<std::vector<const Kernels*>, 2> all = [] {
    std::array<std::vector<const Kernels*>, 2> some;
    for (std::size_t k = 0; k < 2; ++k) {
      some[k] = {&plain::table[k]};
#ifdef MUSLIN_BY_PROCESSOR
      if (__builtin_cpu_supports("x86-64-v3")) some[k].push_back(&avx2::table[k]);
      if (__builtin_cpu_supports("x86-64-v4")) some[k].push_back(&avx512::table[k]);
#endif
    }
    return some;
  }();
  return all[static_cast<std::size_t>(kind)];
}

const Kernels& kernels(Couplings kind) {
  static const std::array<const Kernels*, 2> best = {all_kernels(Couplings::central).back(),
                                                     all_kernels(Couplings::full).back()};
  return *best[static_cast<std::size_t>(kind)];
}

}  // namespace muslin::sweep_kernels
