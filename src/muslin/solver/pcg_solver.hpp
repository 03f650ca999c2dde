// PcgSolver solves the linear systems of a step in float: conjugate gradients on the linearised Hessian
// between the halves of an incomplete factorisation, with a coarse grid where they converge slowly. The
// caller's next iteration, in double, corrects errors of float.
#pragma once

#include <algorithm>
#include <memory>

#include "muslin/solver/coarse_space.hpp"
#include "muslin/solver/conjugate_gradient.hpp"
#include "muslin/solver/eisenstat_pcg.hpp"
#include "muslin/solver/linearization.hpp"

namespace muslin {

class PcgSolver {
 public:
  /// Begins a step and drops data from earlier steps.
  void begin_step() {
    iterations_a_decade_ = 0;
    assembled_ = false;
  }
  /// Linearises at x, which must stay valid while `solve` is called.
  void linearize(const IncrementalPotential& function, ConstVectors x);

  /// Returns the largest ‖diagonal block‖ / mass of a free vertex, of contact or of all other terms.
  double stiffest() const { return std::max(stiffest_, h_.stiffest_relative()); }
  /// Returns false if masses are lost to rounding against stiffnesses in float; then `solve` must not be
  /// used. Contact is limited in the factors and does not count here.
  bool fits_float() const { return stiffest_ <= float_limit; }

  /// True if H has springs. Then it is the true Hessian and may be indefinite.
  bool has_springs() const { return h_.has_springs(); }

  /// Solves H s = b for the Hessian linearised last, as conjugate_gradient does. `norm` receives √(bᵀP⁻¹b).
  /// If the first direction has negative curvature, H is replaced by its projection until the next
  /// linearisation, unless NegativeCurvature::pass is set.
  LinearReport solve(ConstVectors b, const LinearSettings& settings, Vectors s, double& norm);

  /// z = P⁻¹ b, P the incomplete factorisation.
  void precondition(ConstVectors b, Vectors z);

  /// Replaces H by its projection until the next linearisation; false if it was projected already.
  bool project();

  std::size_t bytes() const {
    return h_.bytes() + system_.bytes() + (coarse_space_ ? coarse_space_->bytes() : 0);
  }

 private:
  bool prepare_coarse_space();
  int patience() const;

  Linearization h_;
  EisenstatPcg system_;
  ConstVectors rest_positions_;
  std::unique_ptr<CoarseSpace> coarse_space_;  // kept from step to step
  static constexpr double float_limit = 3e5;
  double stiffest_ = 0;  // of the factors
  bool projected_ = false;
  bool assembled_ = false;          // the coarse matrix, in this step
  double iterations_a_decade_ = 0;  // per decade of the residual, without the coarse space, in this step
};

}  // namespace muslin
