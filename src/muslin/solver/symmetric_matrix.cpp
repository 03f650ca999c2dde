#include "muslin/solver/symmetric_matrix.hpp"

#include <algorithm>
#include <cstring>

#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // the ABI of vectors is irrelevant in inlined code
#endif

namespace muslin {
namespace {

constexpr std::size_t row_grain = 256;  // rows

using Float8 = float __attribute__((vector_size(32)));

/// The first two columns of a block.
MUSLIN_INLINE Float8 columns01(const Float4* block) {
  Float8 both;
  std::memcpy(&both, block, sizeof(both));
  return both;
}

MUSLIN_VECTOR_CODE double add_rows(const SymmetricPattern& pattern, const Float4* blocks, const Float4* p,
                                   Float4* y, std::size_t begin, std::size_t end) {
  const int *const first = pattern.first().data(), *const columns = pattern.columns().data(),
                   *const first_mirrored = pattern.first_mirrored().data();
  const SymmetricPattern::Mirrored* const mirrored = pattern.mirrored().data();
  double sum = 0;
  for (std::size_t v = begin; v < end; ++v) {
    // Sums of the first two columns together and of the third; of blocks, and of transposed ones by
    // component.
    Float8 sum01 = {}, mirrored01 = {};
    Float4 sum2 = {}, mirrored2 = {};
    for (int k = first[v]; k < first[v + 1]; ++k) {
      const Float4 *const c = blocks + 3 * at(k), from = p[columns[k]];
      sum01 += columns01(c) * __builtin_shufflevector(from, from, 0, 0, 0, 0, 1, 1, 1, 1);
      sum2 += c[2] * from[2];
    }
    for (int m = first_mirrored[v]; m < first_mirrored[v + 1]; ++m) {
      const Float4 *const c = blocks + 3 * at(mirrored[m].block), from = p[mirrored[m].row];
      mirrored01 += columns01(c) * __builtin_shufflevector(from, from, 0, 1, 2, 3, 0, 1, 2, 3);
      mirrored2 += c[2] * from;
    }
    const Float8& t = mirrored01;
    const Float4 row =
        __builtin_shufflevector(sum01, sum01, 0, 1, 2, 3) +
        __builtin_shufflevector(sum01, sum01, 4, 5, 6, 7) + sum2 +
        Float4{t[0] + t[1] + t[2], t[4] + t[5] + t[6], mirrored2[0] + mirrored2[1] + mirrored2[2], 0};
    y[v] += row;
    const Float4 work = p[v] * row;
    sum += static_cast<double>(work[0]) + static_cast<double>(work[1]) + static_cast<double>(work[2]);
  }
  return sum;
}

}  // namespace

void SymmetricMatrix::reset(std::shared_ptr<const SymmetricPattern> pattern, std::size_t first, bool zero) {
  pattern_ = std::move(pattern);
  first_ = first;
  columns_.resize(3 * pattern_->block_count());
  if (!zero) return;
  constexpr std::size_t columns_per_piece = 1 << 16;
  parallel_for(columns_.size(), columns_per_piece, [&](std::size_t begin, std::size_t end) {
    std::fill(columns_.data() + begin, columns_.data() + end, Float4{0, 0, 0, 0});
  });
}

void SymmetricMatrix::close_rows() {
  parallel_for(pattern_->vertex_count(), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Float4 sum[3] = {};
      for (int k = pattern_->first()[v] + 1; k < pattern_->first()[v + 1]; ++k)
        for (int c = 0; c < 3; ++c) sum[c] += block(k)[c];
      for (int m = pattern_->first_mirrored()[v]; m < pattern_->first_mirrored()[v + 1]; ++m) {
        const Float4* const columns = block(pattern_->mirrored()[at(m)].block);
        for (int c = 0; c < 3; ++c) sum[c] += Float4{columns[0][c], columns[1][c], columns[2][c], 0};
      }
      Float4* const diagonal = block(pattern_->first()[v]);
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) diagonal[c][r] = -0.5F * (sum[c][r] + sum[r][c]);
    }
  });
}

double SymmetricMatrix::add_product(const Float4* p, Float4* y) const {
  return parallel_sum(pattern_->vertex_count(), row_grain, 0.0, [&](std::size_t begin, std::size_t end) {
    return add_rows(*pattern_, columns_.data(), p, y, begin, end);
  });
}

void SymmetricMatrix::add_diagonal(Floats upper, Floats lower) const {
  parallel_for(pattern_->vertex_count(), row_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Float4* c = block(pattern_->first()[v]);
      upper.x[v] += c[0][0];
      upper.y[v] += c[1][0];
      upper.z[v] += c[2][0];
      lower.x[v] += c[1][1];
      lower.y[v] += c[2][1];
      lower.z[v] += c[2][2];
    }
  });
}

}  // namespace muslin
