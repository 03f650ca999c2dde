#include "muslin/geometry/point_sequence.hpp"

#include <algorithm>

#include "muslin/core/error.hpp"

namespace muslin {

Vec3 PointSequence::at(double time, std::size_t point) const {
  require(!times.empty() && positions.size() == times.size() * points && point < points,
          "a point sequence lacks samples or has no such point", "give #points positions for each time");
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  const auto sample = [&](std::size_t s) { return Vec3(positions[s * points + point].cast<double>()); };
  if (next == times.begin()) return sample(0);
  const auto after = static_cast<std::size_t>(next - times.begin());
  if (after == times.size()) return sample(after - 1);
  const double share = (time - times[after - 1]) / (times[after] - times[after - 1]);
  return sample(after - 1) + share * (sample(after) - sample(after - 1));
}

}  // namespace muslin
