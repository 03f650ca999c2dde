// StepGuard keeps a motion safe where neither an energy nor a common step length can: surfaces must not
// cross. The solver passes every displacement through the guard; contact is one (contact/contact_guard.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "muslin/api.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// Guards one step at a time, from positions that are safe. All vectors are #V by 3, [m].
class MUSLIN_API StepGuard {
 public:
  virtual ~StepGuard() = default;

  /// Begins a step at x; a step begun and not ended is discarded. Others give way to vertices v for which
  /// held[v] (#V) is not 0.
  virtual void begin(ConstVectors x, std::span<const std::uint8_t> held) = 0;

  /// Returns the length up to which motions need not be limited [m].
  virtual double slack() const = 0;

  /// Limits the displacement d from x, vertex by vertex, such that x + t d is safe for all t in [0, 1]. `x`
  /// must have been reached from the start of the step by limited displacements only.
  virtual void limit(ConstVectors x, Vectors d) = 0;
  /// The same for a displacement that moves each group of vertices (#V, −1: of none) as a rigid body. As no
  /// distance within a group changes, only groups close to others are limited.
  virtual void limit(ConstVectors x, Vectors d, std::span<const int> groups) = 0;

  /// Advances x by d in collision-free substeps, however long d is.
  virtual void advance(Vectors x, ConstVectors d) = 0;

  /// Selects normal forces and closest points of friction: those at x, or those of the last potential of this
  /// step.
  enum class Friction { anew, kept };
  /// Returns the energy of contact near x; call at every iterate. Friction is lagged at x, or taken from the
  /// last potential of this step. Valid until the next call.
  virtual const Potential& potential(ConstVectors x, Friction friction) = 0;

  struct Weight {
    int vertex = 0;
    double weight = 0;
  };
  /// A contact of the last potential resists a relative motion Σ weight · u, by the stiffness along the
  /// normal and across it [N/m].
  struct Contact {
    Vec3 normal;
    double normal_stiffness = 0, tangential = 0;
    std::span<const Weight> weights;
  };
  virtual void for_each_contact(const std::function<void(const Contact&)>& visit) const = 0;

  /// Ends the step at x, under the potential requested last.
  virtual void end(ConstVectors x) = 0;
};

}  // namespace muslin
