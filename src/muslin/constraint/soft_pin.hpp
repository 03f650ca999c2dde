// SoftPin pulls the vertices of a pin to their targets by springs and dashpots.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "muslin/constraint/pin.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The force −k (x − t) − c (v − dt/dτ) on every vertex, with its target t at the end of the step, and with k
/// and c times the pin's weight at that time. The pin is outside of the bodies: its springs store no energy
/// of theirs, and its force does work on them, like that of a hard pin. The anchors of the vertices and their
/// forces are in the history.
class SoftPin : public Load {
 public:
  /// Errors: usage, if numbers of vertices and constants differ, or a constant or weight is negative.
  explicit SoftPin(Pin pin);

  std::unique_ptr<Potential> potential(const StepContext& step) const override;
  void end_step(const Potential& potential, ConstVectors x, History& history) const override;

  /// Returns the forces of a soft pin on its vertices in the last step in which it acted [N]; empty before
  /// the first.
  static std::vector<Vec3> forces(const Pin& pin, const History& history);

 private:
  class Springs;

  std::shared_ptr<const Pin> pin_;
  std::string array_;  // of the history
};

}  // namespace muslin
