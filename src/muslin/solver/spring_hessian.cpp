#include "muslin/solver/spring_hessian.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int spring_lanes = SpringHessian::lanes;
constexpr int block_words = 2 * spring_lanes;  // of a block
constexpr float largest_word = 32767, upper_half = 65536;

MUSLIN_VECTOR_CODE void load_blocks(const std::uint32_t* __restrict c, const float* __restrict units,
                                    std::size_t count, float* __restrict sx, float* __restrict sy,
                                    float* __restrict sz, float* __restrict t) {
  for (std::size_t b = 0; b < count; ++b) {
    const float unit = units[b];
    const std::uint32_t* const from = c + b * block_words;
    for (int l = 0; l < spring_lanes; ++l) {
      sx[l] = unit * static_cast<float>(static_cast<std::int32_t>(from[l] << 16));
      sy[l] = unit * static_cast<float>(static_cast<std::int32_t>(from[l] & 0xffff0000U));
      sz[l] = unit * static_cast<float>(static_cast<std::int32_t>(from[spring_lanes + l] << 16));
      t[l] = std::bit_cast<float>(from[spring_lanes + l] & 0xffff0000U);
    }
    sx += spring_lanes, sy += spring_lanes, sz += spring_lanes, t += spring_lanes;
  }
}

MUSLIN_INLINE std::uint32_t rounded(float s) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(s + (s < 0 ? -0.5F : 0.5F)));
}

MUSLIN_VECTOR_CODE void store_blocks(std::uint32_t* __restrict c, float* __restrict units, std::size_t count,
                                     const float* __restrict sx, const float* __restrict sy,
                                     const float* __restrict sz, const float* __restrict t) {
  for (std::size_t b = 0; b < count; ++b) {
    float entry[spring_lanes];
    for (int l = 0; l < spring_lanes; ++l)
      entry[l] = std::max(std::max(std::abs(sx[l]), std::abs(sy[l])), std::abs(sz[l]));
    for (int half = spring_lanes / 2; half > 0; half /= 2)
      for (int l = 0; l < half; ++l) entry[l] = std::max(entry[l], entry[l + half]);
    units[b] = entry[0] / (largest_word * upper_half);
    const float per_unit = entry[0] > 0 ? largest_word / entry[0] : 0;
    std::uint32_t* const to = c + b * block_words;
    for (int l = 0; l < spring_lanes; ++l) {
      const auto bits = std::bit_cast<std::uint32_t>(t[l]);
      to[l] = (rounded(per_unit * sx[l]) & 0xffffU) | rounded(per_unit * sy[l]) << 16;
      to[spring_lanes + l] =
          (rounded(per_unit * sz[l]) & 0xffffU) | ((bits + 0x7fffU + (bits >> 16 & 1U)) & 0xffff0000U);
    }
    sx += spring_lanes, sy += spring_lanes, sz += spring_lanes, t += spring_lanes;
  }
}

/// The eigenvalues are |s|² + t along s and t across: where t < 0, t becomes 0 and s shrinks so that the
/// first is unchanged (but ≥ 0).
MUSLIN_VECTOR_CODE void project_blocks(std::size_t count, float* __restrict sx, float* __restrict sy,
                                       float* __restrict sz, float* __restrict t) {
  for (std::size_t i = 0; i < count * spring_lanes; ++i) {
    const float square = sx[i] * sx[i] + sy[i] * sy[i] + sz[i] * sz[i];
    const float along = std::max(square + std::min(t[i], 0.0F), 0.0F);
    const float scale = std::sqrt(along / std::max(square, 1e-30F));
    sx[i] *= scale, sy[i] *= scale, sz[i] *= scale;
    t[i] = std::max(t[i], 0.0F);
  }
}

}  // namespace

SpringHessian::SpringHessian(std::shared_ptr<const EliminationOrder> pattern, std::size_t first)
    : pattern_(std::move(pattern)), first_(first) {
  coefficients_.resize(block_words * pattern_->block_count() + 2 * room);
  units_.resize(pattern_->block_count());
  clear();
}

void SpringHessian::clear() {
  std::memset(coefficients_.data(), 0, coefficients_.size() * sizeof(std::uint32_t));
  std::fill_n(units_.data(), units_.size(), 0.0F);
}

void SpringHessian::project() {
  constexpr std::size_t batch = 64;
  parallel_for(pattern_->block_count(), 16 * batch, [&](std::size_t begin, std::size_t end) {
    float sx[batch * spring_lanes], sy[batch * spring_lanes], sz[batch * spring_lanes],
        t[batch * spring_lanes];
    for (std::size_t block = begin; block < end; block += batch) {
      const std::size_t count = std::min(batch, end - block);
      load(block, count, sx, sy, sz, t);
      project_blocks(count, sx, sy, sz, t);
      store(block, count, sx, sy, sz, t);
    }
  });
}

void SpringHessian::load(std::size_t block, std::size_t count, float* sx, float* sy, float* sz,
                         float* t) const {
  load_blocks(coefficients() + block_words * block, units() + block, count, sx, sy, sz, t);
}

void SpringHessian::store(std::size_t block, std::size_t count, const float* sx, const float* sy,
                          const float* sz, const float* t) {
  store_blocks(coefficients_.data() + room + block_words * block, units_.data() + block, count, sx, sy, sz,
               t);
}

}  // namespace muslin
