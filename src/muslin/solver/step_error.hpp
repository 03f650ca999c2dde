// StepError estimates the distance of an iterate from the minimum of a step, as a displacement, and compares
// it with the allowed error.
//
// H ⪰ M where the potentials are convex, so the mass-weighted norm of the error is at most that of M⁻¹ g: if
// this norm is small enough, no linear system need be solved. Otherwise the error after a Newton step s is
// estimated as |s| ρ / (1 − ρ), plus the part of s that was removed by the guard and the line search. ρ is
// the rate of convergence: the smaller of ‖g₊‖ / ‖g‖ in the norm of the preconditioner and |s| over the
// length of the last motion. The second ratio counts only if s is at least half as long as the preconditioned
// gradient, because a system that was not solved for this part gives a short s too. Parts are judged
// separately, so that a heavy body does not hide a light one: the error of a part is the larger of the root
// mean square over its masses and 0.03 of the largest error of its vertices.
//
// The allowed error is tolerance · min(a dt², h), with h the mean edge of the part and a the larger of the
// acceleration due to loads and the actual acceleration in this step (root mean squares).
#pragma once

#include <cstdint>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

class StepError {
 public:
  StepError(const StepProblem& problem, const IncrementalPotential& function, double tolerance);

  /// Returns true if the gradient at x is so small that no step is needed.
  bool bound(ConstVectors x, ConstVectors g);
  /// Call before a Newton step, with the gradient g and the preconditioned gradient z.
  void begin(ConstVectors g, ConstVectors z);
  /// Call after a Newton step: s is the solution of the linear system, t d the displacement of x, `from` the
  /// position at the beginning of the integrator's step. Returns true if x is accurate enough.
  bool end(ConstVectors x, ConstVectors from, ConstVectors g, ConstVectors z, ConstVectors s, ConstVectors d,
           double t);
  /// Call if no step could be made; s is the one that was tried.
  void give_up(ConstVectors s);

  double largest() const { return largest_; }  ///< estimate in the worst part [m]
  /// Returns the relative residual of the next linear system that makes the error small enough.
  double wanted_forcing() const;

 private:
  struct Part {
    double mass = 0;
    double norm = 0;      ///< gᵀ z before the step
    double foretold = 0;  ///< Σ m z² before the step
    double gone = 0;      ///< Σ m (t d)² of the last Newton step; 0: none
    double allowed = 0;   ///< [m]
  };
  std::size_t part_of(std::size_t v) const {
    return problem_.parts.empty() ? 0 : static_cast<std::size_t>(problem_.parts[v]);
  }
  /// False for vertices that are held or yield.
  bool counts(std::size_t v) const { return counts_[v] != 0; }
  void find_allowed(ConstVectors x);
  template <class Sum, class Add>
  std::vector<Sum> sum(const Add& add) const;

  const StepProblem& problem_;
  const IncrementalPotential& function_;
  double tolerance_;
  std::vector<std::uint8_t> counts_;
  std::vector<Part> parts_;
  double largest_ = 0;
  double worst_ratio_ = 1;  ///< of estimated to allowed error
};

}  // namespace muslin
