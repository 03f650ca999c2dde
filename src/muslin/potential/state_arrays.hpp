// The names under which what changes during a run is saved and restored. A struct that is part of the state
// declares each of its members once, in a static function
//
//   template <class Self, class Arrays>
//   static void name_arrays(Self& self, Arrays& arrays) {
//     arrays("holds.anchors", self.anchors);
//   }
//
// and whoever writes, reads or compares states passes an `Arrays` that is called with every name and member:
// a std::vector, or a single value, which counts as an array of one.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// How the elements of a named array lie in memory, in a word that is saved beside the name. Whoever keeps
/// elements of another type specialises it; they are copied byte by byte and have no padding.
template <class Element>
struct ArrayElement;

template <>
struct ArrayElement<double> {
  static constexpr std::string_view layout = "f64";
};
template <>
struct ArrayElement<Vec3> {
  static constexpr std::string_view layout = "f64x3";
};
template <>
struct ArrayElement<std::int32_t> {
  static constexpr std::string_view layout = "i32";
};
template <>
struct ArrayElement<std::array<std::int32_t, 2>> {
  static constexpr std::string_view layout = "i32x2";
};
template <>
struct ArrayElement<std::int64_t> {
  static constexpr std::string_view layout = "i64";
};
template <>
struct ArrayElement<std::uint64_t> {
  static constexpr std::string_view layout = "u64";
};
template <>
struct ArrayElement<std::uint8_t> {
  static constexpr std::string_view layout = "u8";
};

}  // namespace muslin
