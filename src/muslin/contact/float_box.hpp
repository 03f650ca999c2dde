// FloatBox is a box in float for the broad phase: four lanes, compared at once.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace muslin {

/// Four floats as one value; GCC and clang make one register of it.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Long2 = std::int64_t __attribute__((vector_size(16)));

struct alignas(32) FloatBox {
  Float4 low{INFINITY, INFINITY, INFINITY, 0};  ///< the last lane is not used
  Float4 high{-INFINITY, -INFINITY, -INFINITY, 0};

  void extend(const FloatBox& b) {
    low = b.low < low ? b.low : low;
    high = b.high > high ? b.high : high;
  }
};

/// Returns true if any of the four lanes is true.
inline bool any(const Int4& mask) {
  const auto halves = std::bit_cast<Long2>(mask);
  return (halves[0] | halves[1]) != 0;
}

/// Return a float at or just below, and at or just above the value: at most two floats away.
inline float rounded_down(double value) {
  const auto f = static_cast<float>(value);
  return f - (std::fabs(f) * std::numeric_limits<float>::epsilon() + std::numeric_limits<float>::min());
}
inline float rounded_up(double value) {
  const auto f = static_cast<float>(value);
  return f + (std::fabs(f) * std::numeric_limits<float>::epsilon() + std::numeric_limits<float>::min());
}

}  // namespace muslin
