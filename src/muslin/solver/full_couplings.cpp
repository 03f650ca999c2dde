#include "muslin/solver/full_couplings.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr int full_lanes = FullCouplings::lanes, full_words = FullCouplings::words;
constexpr std::size_t full_block_words = full_words * full_lanes;
constexpr int bits_below = 11;  // bits under an integer of 21 in a word
constexpr std::uint32_t lower_bits = (1U << bits_below) - 1;
constexpr float largest_integer = (1 << 20) - 2, one_above = 1 << bits_below;
constexpr std::size_t coupling_grain = 256;  // blocks

/// The nearest integer.
MUSLIN_INLINE std::uint32_t nearest_integer(float value) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(value + (value < 0 ? -0.5F : 0.5F)));
}

MUSLIN_VECTOR_CODE void pack_full(const float* __restrict entries, std::uint32_t* __restrict to,
                                  float* __restrict unit) {
  float largest[full_lanes] = {};
  for (int k = 0; k < 9; ++k)
    for (int l = 0; l < full_lanes; ++l)
      largest[l] = std::max(largest[l], std::abs(entries[k * full_lanes + l]));
  for (int half = full_lanes / 2; half > 0; half /= 2)
    for (int l = 0; l < half; ++l) largest[l] = std::max(largest[l], largest[l + half]);
  *unit = largest[0] / (largest_integer * one_above);
  const float per_unit = largest[0] > 0 ? largest_integer / largest[0] : 0;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < full_lanes; ++l) {
      const std::uint32_t split = nearest_integer(per_unit * entries[(6 + k) * full_lanes + l]) << bits_below;
      const std::uint32_t low[2] = {split >> (32 - bits_below), split >> bits_below & lower_bits >> 1};
      for (int half = 0; half < 2; ++half) {
        // The lower bits are read as a part of the entry above them.
        const int entry = (2 * k + half) * full_lanes + l;
        to[entry] = nearest_integer(per_unit * entries[entry] - static_cast<float>(low[half]) / one_above)
                        << bits_below |
                    low[half];
      }
    }
  }
}

/// Loads −B of four couplings, or zeros, into entries of 16 lanes.
void load_full(const SymmetricMatrix& matrix, const int* slots, float* entries) {
  constexpr Float4 zeros[3] = {};
  const Float4* columns[4];
  unsigned turned = 0;
  for (int l = 0; l < 4; ++l) {
    const int slot = slots[l];
    if (slot != FullCouplings::none && slot < 0) turned |= 1U << l;
    columns[l] = slot == FullCouplings::none ? zeros : matrix.block(slot < 0 ? ~slot : slot);
  }
  for (int c = 0; c < 3; ++c) {
    const Float4 xy01 = __builtin_shufflevector(columns[0][c], columns[1][c], 0, 4, 1, 5),
                 xy23 = __builtin_shufflevector(columns[2][c], columns[3][c], 0, 4, 1, 5),
                 z01 = __builtin_shufflevector(columns[0][c], columns[1][c], 2, 6, 3, 7),
                 z23 = __builtin_shufflevector(columns[2][c], columns[3][c], 2, 6, 3, 7);
    const Float4 rows[3] = {-__builtin_shufflevector(xy01, xy23, 0, 1, 4, 5),
                            -__builtin_shufflevector(xy01, xy23, 2, 3, 6, 7),
                            -__builtin_shufflevector(z01, z23, 0, 1, 4, 5)};
    for (int r = 0; r < 3; ++r)
      std::memcpy(entries + full_lanes * (turned == 0 ? 3 * r + c : 3 * c + r), &rows[r], sizeof(Float4));
  }
  if (turned == 0) return;
  for (int l = 0; l < 4; ++l) {
    if ((turned >> l & 1U) != 0) continue;
    for (const auto& [i, j] : {std::pair{1, 3}, {2, 6}, {5, 7}})
      std::swap(entries[full_lanes * i + l], entries[full_lanes * j + l]);
  }
}

}  // namespace

void FullCouplings::set(const SymmetricMatrix& matrix, std::span<const int> slots) {
  const std::size_t blocks = slots.size() / full_lanes;
  if (units_.size() != blocks) {
    coefficients_.resize(full_block_words * blocks + 2 * room);
    std::fill_n(coefficients_.data(), coefficients_.size(), 0U);
    units_.resize(blocks);
  }
  parallel_for(blocks, coupling_grain, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t ahead = 8 * full_lanes;
    for (std::size_t b = begin; b < end; ++b) {
      float entries[9 * full_lanes];
      for (std::size_t i = b * full_lanes; i < (b + 1) * full_lanes; ++i) {
        // The order of elimination jumps from row to row, which hardware prefetchers do not predict.
        const int next = slots[std::min(i + ahead, slots.size() - 1)];
        if (next == none) continue;
        const Float4* const block = matrix.block(next < 0 ? ~next : next);
        __builtin_prefetch(block);
        __builtin_prefetch(block + 2);
      }
      for (std::size_t l = 0; l < full_lanes; l += 4)
        load_full(matrix, &slots[b * full_lanes + l], entries + l);
      pack_full(entries, coefficients_.data() + room + full_block_words * b, units_.data() + b);
    }
  });
}

void FullCouplings::load(std::size_t block, std::span<float, 9 * full_lanes> entries) const {
  const std::uint32_t* const from = coefficients() + full_block_words * block;
  const auto value = [&](std::uint32_t bits) {
    return units_.data()[block] * static_cast<float>(static_cast<std::int32_t>(bits));
  };
  for (std::size_t l = 0; l < full_lanes; ++l) {
    const auto word = [&](std::size_t k) { return from[k * full_lanes + l]; };
    for (std::size_t k = 0; k < 6; ++k) entries[k * full_lanes + l] = value(word(k));
    for (std::size_t k = 0; k < 3; ++k)
      entries[(6 + k) * full_lanes + l] =
          value(word(2 * k) << (32 - bits_below) | (word(2 * k + 1) & lower_bits) << bits_below);
  }
}

}  // namespace muslin
