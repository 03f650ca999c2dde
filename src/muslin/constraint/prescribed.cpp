#include "muslin/constraint/prescribed.hpp"

#include <algorithm>

#include "muslin/core/error.hpp"

namespace muslin {

void Prescribed::positions(double time, Vectors x) const {
  require(x.size() == start.size(), "prescribed vertices need one position each", "give #V positions");
  if (sequence) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = placement * sequence->at(time, i);
    return;
  }
  if (motion.keys.empty()) {
    std::copy(start.begin(), start.end(), x.begin());
    return;
  }
  const Eigen::Isometry3d moved = motion.at(time) * motion.at(0).inverse();
  for (std::size_t i = 0; i < start.size(); ++i) x[i] = moved * start[i];
}

void Prescribed::hold(double time_end, std::span<std::uint8_t> fixed, Vectors targets) const {
  const auto begin = static_cast<std::size_t>(first);
  positions(time_end, targets.subspan(begin, start.size()));
  std::fill_n(fixed.begin() + first, start.size(), std::uint8_t{1});
}

}  // namespace muslin
