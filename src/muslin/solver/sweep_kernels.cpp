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

std::span<const Kernels* const> all_kernels() {
  static const std::vector<const Kernels*> all = [] {
    std::vector<const Kernels*> some = {&plain::table};
#ifdef MUSLIN_BY_PROCESSOR
    if (__builtin_cpu_supports("x86-64-v3")) some.push_back(&avx2::table);
    if (__builtin_cpu_supports("x86-64-v4")) some.push_back(&avx512::table);
#endif
    return some;
  }();
  return all;
}

const Kernels& kernels() {
  static const Kernels& best = *all_kernels().back();
  return best;
}

}  // namespace muslin::sweep_kernels
