// StepGuard limits motion vertex by vertex where neither an energy nor a common step length suffices:
// surfaces must not cross. The solver passes every displacement through the guard. Contact is a guard
// (contact/contact_guard.hpp).
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

  /// Begins a step at x; a step begun and not ended is discarded. held[v] (#V) is not 0 for held vertices, to
  /// which all others give way.
  virtual void begin(ConstVectors x, std::span<const std::uint8_t> held) = 0;

  /// Returns the length up to which motions need not be limited [m].
  virtual double slack() const = 0;

  /// Limits the displacement d from x, vertex by vertex, such that x + t d is safe for all t in [0, 1]. `x`
  /// must have been reached from the start of the step by limited displacements only.
  virtual void limit(ConstVectors x, Vectors d) = 0;
  /// Limits a displacement that moves each group of vertices as a rigid body. `groups` (#V) is the group of
  /// each vertex, −1 for none. No distance within a group changes, so only groups close to others are
  /// limited.
  virtual void limit(ConstVectors x, Vectors d, std::span<const int> groups) = 0;

  /// Advances x by d in collision-free substeps, however long d is.
  virtual void advance(Vectors x, ConstVectors d) = 0;

  /// Selects where friction takes its normal forces and closest points: at x (anew), or from the last
  /// potential of this step (kept). Its Hessian is then the secant, whose steps do not overshoot, or the
  /// tangent (kept_tangent): no stiffness along a slip.
  enum class Friction { anew, kept, kept_tangent };
  /// Returns the energy of contact near x; call at every iterate. Friction is lagged at x, or taken from the
  /// last potential of this step. Valid until the next call.
  virtual const Potential& potential(ConstVectors x, Friction friction) = 0;

  struct Weight {
    int vertex = 0;
    double weight = 0;
  };
  /// A contact of the last potential. It resists the relative motion Σ weight · u with a normal and a
  /// tangential stiffness [N/m].
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
