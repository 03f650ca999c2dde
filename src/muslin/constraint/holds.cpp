#include "muslin/constraint/holds.hpp"

#include <algorithm>
#include <cassert>

#include "muslin/constraint/pin_targets.hpp"

namespace muslin {

void Holds::step(std::span<const Pin> pins, double time_begin, double time_end, ConstVectors positions,
                 std::span<std::uint8_t> fixed, Vectors targets) {
  assert(time_end >= time_begin);  // an untangled start stands still
  assert(fixed.size() == positions.size() && targets.size() == positions.size());
  if (holding.size() != pins.size()) {
    std::size_t count = 0;
    for (const Pin& pin : pins) count += pin.vertices.size();
    holding.assign(pins.size(), 0);
    anchors.assign(count, Vec3::Zero());
  }
  std::fill(fixed.begin(), fixed.end(), std::uint8_t{0});
  std::copy(positions.begin(), positions.end(), targets.begin());

  std::size_t first = 0;
  for (std::size_t p = 0; p < pins.size(); ++p) {
    const Pin& pin = pins[p];
    const Vectors anchor = Vectors(anchors).subspan(first, pin.vertices.size());
    first += pin.vertices.size();
    if (pin.is_soft() || !pin.acts(time_begin, time_end)) {
      holding[p] = 0;
      continue;
    }
    if (!holding[p]) {
      for (std::size_t i = 0; i < anchor.size(); ++i)
        anchor[i] = PinTargets::first_anchor(pin, time_begin, i,
                                             positions[static_cast<std::size_t>(pin.vertices[i])]);
      holding[p] = 1;
    }
    const PinTargets at_end(pin, time_end);
    for (std::size_t i = 0; i < anchor.size(); ++i) {
      const auto v = static_cast<std::size_t>(pin.vertices[i]);
      fixed[v] = 1;
      targets[v] = at_end.at(i, anchor[i]);
    }
  }
}

void Holds::reanchor(std::span<const Pin> pins, double time, ConstVectors positions) {
  if (holding.size() != pins.size()) return;
  std::size_t first = 0;
  for (std::size_t p = 0; p < pins.size(); ++p) {
    const Pin& pin = pins[p];
    const PinTargets now(pin, time);
    for (std::size_t i = 0; holding[p] && i < pin.vertices.size(); ++i)
      anchors[first + i] = now.anchor(i, positions[static_cast<std::size_t>(pin.vertices[i])]);
    first += pin.vertices.size();
  }
}

}  // namespace muslin
