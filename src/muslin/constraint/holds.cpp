#include "muslin/constraint/holds.hpp"

#include <algorithm>
#include <cassert>

namespace muslin {
namespace {

/// Returns the motion from the positions at the pin's beginning to those at `time`.
Eigen::Isometry3d motion_since(const Pin& pin, double time) {
  if (pin.motion.keys.empty()) return Eigen::Isometry3d::Identity();
  return pin.motion.at(time) * pin.motion.at(std::max(pin.from, 0.0)).inverse();
}

}  // namespace

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
    const Eigen::Isometry3d motion = motion_since(pin, time_end);
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

void Holds::reanchor(std::span<const Pin> pins, double time, ConstVectors positions) {
  if (holding.size() != pins.size()) return;
  std::size_t first = 0;
  for (std::size_t p = 0; p < pins.size(); ++p) {
    const Pin& pin = pins[p];
    const bool moves = !pin.motion.keys.empty();
    const Eigen::Isometry3d back = motion_since(pin, time).inverse();
    for (std::size_t i = 0; holding[p] && i < pin.vertices.size(); ++i) {
      const Vec3& now = positions[static_cast<std::size_t>(pin.vertices[i])];
      if (pin.sequence) {
        anchors[first + i] = now - pin.sequence->at(time, static_cast<std::size_t>(pin.points[i]));
      } else {
        anchors[first + i] = moves ? Vec3(back * now) : now;
      }
    }
    first += pin.vertices.size();
  }
}

}  // namespace muslin
