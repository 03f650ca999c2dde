// How far an iterate of a step is from its minimum, seen as motion, and what of that is allowed.
//
// H ⪰ M where the potentials are convex, so that the mass-weighted norm of the error is at most that of
// M⁻¹ g: where that alone is small enough nothing need be solved for. Otherwise the error after a Newton step
// s is taken to be |s| ρ / (1 − ρ), plus what was taken from s. ρ is the rate of convergence: ‖g₊‖ / ‖g‖ in
// the norm of the preconditioner, or the length of s over that of the last motion, whichever is less. The
// latter counts only if s is as long as what the preconditioner alone foretells: a system that was not solved
// for this part gives a short s as well. Bodies are judged part by part, so that a heavy one does not hide a
// light one: the root mean square over the masses of a part, and 0.03 of the largest error of its vertices.
//
// Allowed are tolerance · min(a dt², h): h the mean edge of the part, a the larger of the acceleration that
// loads give it and of what it is accelerated by in this step (root mean squares).
#pragma once

#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {

class StepError {
 public:
  StepError(const StepProblem& problem, const IncrementalPotential& function, double tolerance);

  /// Whether the gradient at x is so small that no step is needed.
  bool bound(ConstVectors x, ConstVectors g);
  /// Before a step: the gradient, and the preconditioned one.
  void begin(ConstVectors g, ConstVectors z);
  /// After it: s was solved for, t d is what x went. Returns whether x is good enough. `from`: where the step
  /// of the integrator began.
  bool end(ConstVectors x, ConstVectors from, ConstVectors g, ConstVectors z, ConstVectors s, ConstVectors d,
           double t);
  /// No step could be made; s is what was tried.
  void give_up(ConstVectors s);

  double largest() const { return largest_; }  ///< estimate in the worst part [m]
  /// The relative residual with which the next linear system makes the error small enough.
  double wanted_forcing() const;

 private:
  struct Part {
    double mass = 0;
    double norm = 0;      ///< gᵀ z before the step
    double foretold = 0;  ///< Σ m z² before the step
    double gone = 0;      ///< Σ m (t d)² of the Newton step before; 0: none
    double allowed = 0;   ///< [m]
  };
  std::size_t part_of(std::size_t v) const {
    return problem_.parts.empty() ? 0 : static_cast<std::size_t>(problem_.parts[v]);
  }
  void find_allowed(ConstVectors x);
  template <class Sum, class Add>
  std::vector<Sum> sum(const Add& add) const;

  const StepProblem& problem_;
  const IncrementalPotential& function_;
  double tolerance_;
  std::vector<Part> parts_;
  double largest_ = 0;
  double worst_ratio_ = 1;  ///< of estimate and allowed
};

}  // namespace muslin
