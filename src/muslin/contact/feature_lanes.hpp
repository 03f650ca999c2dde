// Boxes of features in groups of eight, compared all at once: the inner loops of the broad phase.
#pragma once

#include <bit>
#include <cstdint>

#include "muslin/contact/float_box.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {

constexpr int lane_count = 8;

/// Eight values as one; GCC and clang make of it what registers there are.
using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Byte8 = std::int8_t __attribute__((vector_size(8)));

/// One bit for each lane, in the lowest of its byte.
using LaneBits = std::uint64_t;
inline int first_lane(LaneBits bits) { return std::countr_zero(bits) / 8; }
inline LaneBits lanes_after(int lane) { return ~LaneBits{0} << 7 << (8 * lane + 1); }

/// Eight features of one kind; unused lanes have empty boxes.
struct alignas(64) FeatureLanes {
  Float8 low[3], high[3];
  Int8 points[3];  ///< of the feature; unused ones are −1
  Int8 id;         ///< of point, edge or triangle

  FeatureLanes() {
    for (int i = 0; i < lane_count; ++i) {
      set_box(i, FloatBox());
      for (Int8& row : points) row[i] = -1;
      id[i] = -1;
    }
  }
  void set_box(int lane, const FloatBox& box) {
    for (int k = 0; k < 3; ++k) {
      low[k][lane] = box.low[k];
      high[k][lane] = box.high[k];
    }
  }
};

/// A lane of `mask` is −1 or 0.
MUSLIN_INLINE LaneBits as_bits(const Int8& mask) {
  return std::bit_cast<LaneBits>(__builtin_convertvector(mask, Byte8)) & 0x0101010101010101U;
}

/// The lanes that overlap the box.
MUSLIN_INLINE LaneBits lanes_in_box(const FeatureLanes& lanes, const FloatBox& box) {
  return as_bits((lanes.low[0] <= box.high[0]) & (lanes.high[0] >= box.low[0]) &
                 (lanes.low[1] <= box.high[1]) & (lanes.high[1] >= box.low[1]) &
                 (lanes.low[2] <= box.high[2]) & (lanes.high[2] >= box.low[2]));
}

/// The lanes of b that overlap lane i of a and share no point with it, which has `a_points` of them.
template <int a_points, int b_points>
MUSLIN_INLINE LaneBits lanes_near(const FeatureLanes& a, int i, const FeatureLanes& b) {
  Int8 hit = (b.low[0] <= a.high[0][i]) & (b.high[0] >= a.low[0][i]) & (b.low[1] <= a.high[1][i]) &
             (b.high[1] >= a.low[1][i]) & (b.low[2] <= a.high[2][i]) & (b.high[2] >= a.low[2][i]);
  for (int p = 0; p < a_points; ++p)
    for (int q = 0; q < b_points; ++q) hit &= b.points[q] != a.points[p][i];
  return as_bits(hit);
}

}  // namespace muslin
