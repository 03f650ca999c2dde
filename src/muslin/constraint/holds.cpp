#include "muslin/constraint/holds.hpp"

#include <algorithm>
#include <cassert>

namespace muslin {

void Holds::step(std::span<const Pin> pins, double time_begin, double time_end, ConstVectors positions,
                 std::span<std::uint8_t> fixed, Vectors targets) {
  assert(time_end > time_begin);
  assert(fixed.size() == positions.size() && targets.size() == positions.size());
  if (holding.size() != pins.size()) {
    std::size_t count = 0;
    for (const Pin& pin : pins) count += pin.vertices.size();
    holding.assign(pins.size(), 0);
    anchors.assign(count, Vec3::Zero());
  }
  std::fill(fixed.begin(), fixed.end(), std::uint8_t{0});
  std::copy(positions.begin(), positions.end(), targets.begin());

  const double now = time_end + 1e-6 * (time_end - time_begin);
  std::size_t first = 0;
  for (std::size_t p = 0; p < pins.size(); ++p) {
    const Pin& pin = pins[p];
    const Vectors anchor = Vectors(anchors).subspan(first, pin.vertices.size());
    first += pin.vertices.size();
    if (!pin.active(now)) {
      holding[p] = 0;
      continue;
    }
    if (!holding[p]) {
      for (std::size_t i = 0; i < anchor.size(); ++i) {
        anchor[i] = positions[static_cast<std::size_t>(pin.vertices[i])];
        if (pin.sequence) anchor[i] -= pin.sequence->at(time_begin, static_cast<std::size_t>(pin.points[i]));
      }
      holding[p] = 1;
    }
    const bool moves = !pin.motion.keys.empty();
    const Eigen::Isometry3d motion =
        moves ? pin.motion.at(time_end) * pin.motion.at(std::max(pin.from, 0.0)).inverse()
              : Eigen::Isometry3d::Identity();
    for (std::size_t i = 0; i < anchor.size(); ++i) {
      const auto v = static_cast<std::size_t>(pin.vertices[i]);
      fixed[v] = 1;
      if (pin.sequence) {
        targets[v] = anchor[i] + pin.sequence->at(time_end, static_cast<std::size_t>(pin.points[i]));
      } else {
        targets[v] = moves ? Vec3(motion * anchor[i]) : anchor[i];
      }
    }
  }
}

}  // namespace muslin
