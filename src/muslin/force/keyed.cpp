#include "muslin/force/keyed.hpp"

#include <algorithm>
#include <cassert>

#include "muslin/core/error.hpp"

namespace muslin {

namespace {

template <class Key>
auto value_at(const std::vector<Key>& keys, double time) -> decltype(Key::value) {
  require(!keys.empty(), "a keyed quantity has no keys", "give at least one");
  const auto next =
      std::upper_bound(keys.begin(), keys.end(), time, [](double t, const Key& key) { return t < key.time; });
  if (next == keys.begin()) return keys.front().value;
  if (next == keys.end()) return keys.back().value;
  const Key& a = *(next - 1);
  const Key& b = *next;
  return a.value + (time - a.time) / (b.time - a.time) * (b.value - a.value);
}

}  // namespace

Vec3 Keyed::at(double time) const { return value_at(keys, time); }

double KeyedNumber::at(double time) const { return value_at(keys, time); }

Vec3 Keyed::integral(double time) const {
  // The value is linear between consecutive nodes, so the trapezoidal rule is exact.
  Vec3 sum = Vec3::Zero();
  double begin = 0;
  for (const Key& key : keys) {
    if (key.time <= begin) continue;
    if (key.time >= time) break;
    sum += 0.5 * (key.time - begin) * (at(begin) + key.value);
    begin = key.time;
  }
  return sum + 0.5 * (time - begin) * (at(begin) + at(time));
}

double Window::share(double begin, double end) const {
  const double length = end - begin;
  assert(length > 0);
  const double share = (std::min(end, until) - std::max(begin, from)) / length;
  if (share < 1e-6) return 0;
  return share > 1 - 1e-6 ? 1 : share;
}

double Window::sample(double end) const { return std::min(end, until); }

}  // namespace muslin
