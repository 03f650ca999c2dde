// What keeps a motion safe where no energy and no single step length can: surfaces that may not cross. The
// solver asks a guard before it moves anything; contact is one (contact/contact_guard.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// Guards one step at a time, from positions that are safe. All vectors are #V by 3, [m].
class StepGuard {
 public:
  virtual ~StepGuard() = default;

  /// A step begins at x; one that was begun and not ended is forgotten. Others give way to vertices v for
  /// which held[v] (#V) is not 0.
  virtual void begin(ConstVectors x, std::span<const std::uint8_t> held) = 0;

  /// Motions up to this length need not be limited [m].
  virtual double slack() const = 0;

  /// Changes the displacement d from x, vertex by vertex, such that the straight way to x + t d is safe for
  /// all t in [0, 1]. `x` must have been reached from where the step began by such ways only.
  virtual void limit(ConstVectors x, Vectors d) = 0;
  /// The same for a displacement that moves each group of vertices (#V, −1: of none) as a rigid body. That
  /// brings nothing within a group closer, so that only groups that are close to others are limited.
  virtual void limit(ConstVectors x, Vectors d, std::span<const int> groups) = 0;

  /// Advances x by d in collision-free substeps, however long d is.
  virtual void advance(Vectors x, ConstVectors d) = 0;

  /// Normal forces and closest points of friction: those at x, or those of the last potential of this step.
  enum class Friction { anew, kept };
  /// The energy of contact near x: to be asked for anew at every iterate. Friction is lagged at x, or kept as
  /// the last potential of this step has it. Valid until the next call.
  virtual const Potential& potential(ConstVectors x, Friction friction) = 0;

  struct Weight {
    int vertex = 0;
    double weight = 0;
  };
  /// What the potential asked for last resists: a relative motion Σ weight · u, by the stiffness along the
  /// normal and across it [N/m].
  struct Contact {
    Vec3 normal;
    double normal_stiffness = 0, tangential = 0;
    std::span<const Weight> weights;
  };
  virtual void for_each_contact(const std::function<void(const Contact&)>& visit) const = 0;

  /// The step ends at x, under the potential that was asked for last.
  virtual void end(ConstVectors x) = 0;
};

}  // namespace muslin
