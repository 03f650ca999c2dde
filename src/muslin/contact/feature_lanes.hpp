// Compares boxes of features in groups of eight: the inner loops of the broad phase.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "muslin/contact/float_box.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {

constexpr int lane_count = 8;

/// Eight values as one; GCC and clang map it to the available registers.
using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Byte8 = std::int8_t __attribute__((vector_size(8)));

/// One bit for each lane, in the lowest of its byte.
using LaneBits = std::uint64_t;
inline int first_lane(LaneBits bits) { return std::countr_zero(bits) / 8; }
inline LaneBits lanes_after(int lane) { return ~LaneBits{0} << 7 << (8 * lane + 1); }

/// A box at the beginning and at the end of a motion; without motion only the first is used.
struct MovingBox {
  FloatBox ends[2];
};
/// Eight boxes.
struct alignas(64) BoxLanes {
  Float8 low[3], high[3];

  BoxLanes() {
    for (int i = 0; i < lane_count; ++i) set(i, FloatBox());
  }
  void set(int lane, const FloatBox& box) {
    for (int k = 0; k < 3; ++k) {
      low[k][lane] = box.low[k];
      high[k][lane] = box.high[k];
    }
  }
};

/// Eight features of one kind; unused lanes have empty boxes.
struct alignas(64) FeatureLanes {
  BoxLanes begin;
  Int8 points[3];  ///< of the feature; unused ones are −1
  Int8 id;         ///< of point, edge or triangle

  FeatureLanes() {
    for (Int8& row : points) row = ~Int8{};
    id = ~Int8{};
  }
};

/// Features of one kind in groups, and their boxes at the end of a motion.
struct FeatureGroups {
  std::vector<FeatureLanes> lanes;
  std::vector<BoxLanes> ends;

  BoxLanes& boxes(int end, std::size_t group) { return end == 0 ? lanes[group].begin : ends[group]; }
};

/// Returns the lanes of `mask`, −1 or 0 each, as bits.
MUSLIN_INLINE LaneBits as_bits(const Int8& mask) {
  return std::bit_cast<LaneBits>(__builtin_convertvector(mask, Byte8)) & 0x0101010101010101U;
}

/// Returns the lanes of a group that may overlap low(end, axis) … high(end, axis) at some time. Boxes
/// separated along an axis at both ends, on the same side, are separated in between.
template <int ends, class Low, class High>
MUSLIN_INLINE LaneBits overlapping(const FeatureGroups& groups, int group, const Low& low, const High& high) {
  const auto g = static_cast<std::size_t>(group);
  const BoxLanes& begin = groups.lanes[g].begin;
  Int8 hit = ~Int8{};
  for (int k = 0; k < 3; ++k) {
    Int8 reaches = begin.low[k] <= high(0, k), is_reached = begin.high[k] >= low(0, k);
    if constexpr (ends == 2) {
      const BoxLanes& end = groups.ends[g];
      reaches |= end.low[k] <= high(1, k);
      is_reached |= end.high[k] >= low(1, k);
    }
    hit &= reaches & is_reached;
  }
  return as_bits(hit);
}
template <int ends>
MUSLIN_INLINE LaneBits lanes_in_box(const FeatureGroups& groups, int group, const MovingBox& box) {
  return overlapping<ends>(
      groups, group, [&](int end, int k) { return box.ends[end].low[k]; },
      [&](int end, int k) { return box.ends[end].high[k]; });
}

/// Returns the lanes of group h that may overlap lane i of group g and share none of its `a_points` points.
template <int ends, int a_points, int b_points>
MUSLIN_INLINE LaneBits lanes_near(const FeatureGroups& a, int g, int i, const FeatureGroups& b, int h) {
  const FeatureLanes &first = a.lanes[static_cast<std::size_t>(g)],
                     &second = b.lanes[static_cast<std::size_t>(h)];
  const auto boxes = [&](int end) -> const BoxLanes& {
    return end == 0 ? first.begin : a.ends[static_cast<std::size_t>(g)];
  };
  const LaneBits bits = overlapping<ends>(
      b, h, [&](int end, int k) { return boxes(end).low[k][i]; },
      [&](int end, int k) { return boxes(end).high[k][i]; });
  Int8 others = ~Int8{};
  for (int p = 0; p < a_points; ++p)
    for (int q = 0; q < b_points; ++q) others &= second.points[q] != first.points[p][i];
  return bits & as_bits(others);
}

}  // namespace muslin
