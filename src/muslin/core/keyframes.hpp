// Interpolates between keyframes: structs with a `time` [s] and an `interpolation`, in lists whose times
// ascend strictly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "muslin/core/error.hpp"

namespace muslin {

/// The way from a keyframe to the next.
enum class Interpolation {
  linear,  ///< at a constant rate
  step,    ///< at once, when the next is reached
  smooth,  ///< 3s² − 2s³ of the way after a share s of the time: begins and ends at rest, never overshoots
};

struct NumberKeyframe {
  double time = 0;  ///< [s]
  double value = 0;
  Interpolation interpolation = Interpolation::linear;  ///< to the next keyframe

  bool operator==(const NumberKeyframe&) const = default;
};

/// Returns the share of the way that is done after a share s of the time, 0 ≤ s < 1.
inline double share_done(Interpolation interpolation, double s) {
  if (interpolation == Interpolation::step) return 0;
  return interpolation == Interpolation::linear ? s : s * s * (3 - 2 * s);
}

/// Returns the integral of share_done from 0 to s, 0 ≤ s ≤ 1.
inline double integral_of_share(Interpolation interpolation, double s) {
  if (interpolation == Interpolation::step) return 0;
  return interpolation == Interpolation::linear ? 0.5 * s * s : s * s * s * (1 - 0.5 * s);
}

/// The keyframes around a time: the last at or before it and the next; both the same outside of all.
template <class Key>
struct KeyframePair {
  const Key &from, &to;
  double time_share = 0;  ///< of the time between them, 0 … 1

  bool is_single() const { return &from == &to; }
  double share() const { return share_done(from.interpolation, time_share); }  ///< of the way
};

/// Finds the keyframes around `time`; there must be at least one. A keyframe counts as reached a nanosecond
/// early, so that rounding of the clock does not delay it by a step.
template <class Key>
KeyframePair<Key> keyframes_around(const std::vector<Key>& keys, double time) {
  require(!keys.empty(), "a keyed quantity has no keys", "give at least one");
  constexpr double early = 1e-9;  // [s]
  const auto next = std::upper_bound(keys.begin(), keys.end(), time + early,
                                     [](double t, const Key& key) { return t < key.time; });
  if (next == keys.begin()) return {keys.front(), keys.front()};
  if (next == keys.end()) return {keys.back(), keys.back()};
  const Key& from = *(next - 1);
  return {from, *next, std::max(0.0, time - from.time) / (next->time - from.time)};
}

/// Returns the `value` of the keyframes at `time`: constant before the first and after the last.
template <class Key>
auto value_at(const std::vector<Key>& keys, double time) -> decltype(Key::value) {
  const KeyframePair<Key> around = keyframes_around(keys, time);
  if (around.is_single()) return around.from.value;
  return around.from.value + around.share() * (around.to.value - around.from.value);
}

/// Returns the integral of value_at over the times `begin` to `end`, exactly.
template <class Key>
auto integral_over(const std::vector<Key>& keys, double begin, double end) -> decltype(Key::value) {
  const auto part = [&](double from, double to) -> decltype(Key::value) {
    const KeyframePair<Key> around = keyframes_around(keys, from);
    const Interpolation interpolation = around.from.interpolation;
    if (around.is_single() || interpolation == Interpolation::step) return (to - from) * around.from.value;
    // The trapezoidal rule is exact between two keys.
    if (interpolation == Interpolation::linear)
      return 0.5 * (to - from) * (value_at(keys, from) + value_at(keys, to));
    const double duration = around.to.time - around.from.time;
    const double way = integral_of_share(interpolation, (to - around.from.time) / duration) -
                       integral_of_share(interpolation, around.time_share);
    return (to - from) * around.from.value + duration * way * (around.to.value - around.from.value);
  };
  decltype(Key::value) sum = 0 * keys.front().value;
  for (const Key& key : keys) {
    if (key.time <= begin) continue;
    if (key.time >= end) break;
    sum += part(begin, key.time);
    begin = key.time;
  }
  return sum + part(begin, end);
}

}  // namespace muslin
