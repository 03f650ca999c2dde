#include "muslin/constraint/pin_targets.hpp"

#include <algorithm>

namespace muslin {
namespace {

Vec3 point_of_sequence(const Pin& pin, double time, std::size_t i) {
  return pin.sequence->at(time, static_cast<std::size_t>(pin.points[i]));
}

}  // namespace

PinTargets::PinTargets(const Pin& pin, double time)
    : pin_(pin),
      time_(time),
      moves_(!pin.motion.keys.empty()),
      motion_(pin.begins_late() ? pin.motion.between(pin.from, time) : pin.motion.from_model(time)) {}

Vec3 PinTargets::at(std::size_t i, const Vec3& anchor) const {
  if (pin_.sequence) return anchor + point_of_sequence(pin_, time_, i);
  return moves_ ? Vec3(motion_ * anchor) : anchor;
}

Vec3 PinTargets::anchor(std::size_t i, const Vec3& position) const {
  if (pin_.sequence) return position - point_of_sequence(pin_, time_, i);
  return moves_ ? Vec3(motion_.inverse() * position) : position;
}

Vec3 PinTargets::first_anchor(const Pin& pin, double time, std::size_t i, const Vec3& position) {
  if (!pin.sequence && time <= std::max(pin.from, 0.0)) return position;
  return PinTargets(pin, time).anchor(i, position);
}

}  // namespace muslin
