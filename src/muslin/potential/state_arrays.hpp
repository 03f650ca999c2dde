// State arrays are the named parts of the state of a run, under which it is saved and restored. A struct that
// is part of the state declares each of its members once, in a static function
//
//   template <class Self, class Arrays>
//   static void name_arrays(Self& self, Arrays& arrays) {
//     arrays("holds.anchors", self.anchors);
//   }
//
// Code that writes, reads or compares states passes an `Arrays` that is called with every name and member: a
// std::vector, or a single value, which counts as an array of one.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "muslin/core/vectors.hpp"

namespace muslin {

/// Memory layout of the elements of a named array, as a word that is saved with the name. Specialise it for
/// other element types; they are copied byte by byte and have no padding.
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
