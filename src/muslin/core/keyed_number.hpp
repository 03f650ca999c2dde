// KeyedNumber is a number that keyframes change over time.
#pragma once

#include <algorithm>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/keyframes.hpp"

namespace muslin {

/// A number, constant or keyframed: interpolated between the keys, constant before the first and after the
/// last.
struct MUSLIN_API KeyedNumber {
  KeyedNumber() = default;
  KeyedNumber(double constant) : keys{{0, constant}} {}  // NOLINT(google-explicit-constructor): is one
  using Key = NumberKeyframe;
  std::vector<Key> keys;  ///< at least one, times ascend strictly

  bool is_constant() const { return keys.size() == 1; }
  double at(double time) const { return is_constant() ? keys.front().value : value_at(keys, time); }
  /// ∫₀ᵗ at(s) ds for t ≥ 0, exactly.
  double integral(double time) const { return integral_over(keys, 0, time); }
  /// Return the least and the greatest number at any time: those of keys, as the way between two never
  /// overshoots.
  double least() const { return std::min_element(keys.begin(), keys.end(), is_lower)->value; }
  double greatest() const { return std::max_element(keys.begin(), keys.end(), is_lower)->value; }
  bool operator==(const KeyedNumber&) const = default;

 private:
  static bool is_lower(const Key& a, const Key& b) { return a.value < b.value; }
};

}  // namespace muslin
