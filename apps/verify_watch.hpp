// Watch tracks the energy balance and the convergence of a run from frame to frame.
#pragma once

#include <limits>

#include "muslin/hosts.hpp"

namespace muslin::app {

/// Follows one run. The energy is kinetic + elastic + potential.
class Watch {
 public:
  explicit Watch(const Simulation& simulation);
  /// Records the current frame; call after every frame.
  void look(const Simulation& simulation);
  void advance(Simulation& simulation, int frames);

  double gained() const { return gained_; }  ///< largest rise of the energy above its earlier minimum [J]
  double gained_share() const { return gained_share_; }      ///< of the potential energy given up so far
  double balance_gained() const { return balance_gained_; }  ///< the same for Diagnostics::balance() [J]
  double fallen() const { return fallen_; }  ///< most potential energy given up since the start [J]
  double largest_kinetic() const { return largest_kinetic_; }  ///< [J]
  double largest_stretch() const { return largest_stretch_; }
  int unconverged_steps() const { return unconverged_steps_; }
  int max_held_back() const { return max_held_back_; }  ///< vertices, of a frame

 private:
  double start_potential_;
  double least_energy_, least_balance_;
  double gained_ = 0, gained_share_ = 0, balance_gained_ = 0;
  double fallen_ = 0, largest_kinetic_ = 0, largest_stretch_ = 0;
  int unconverged_steps_ = 0, max_held_back_ = 0;
};

}  // namespace muslin::app
