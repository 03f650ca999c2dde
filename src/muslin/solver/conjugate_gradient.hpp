// Solves with the Hessian of the incremental potential, which need not be positive definite, by
// preconditioned conjugate gradients.
#pragma once

#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/preconditioner.hpp"

namespace muslin {

enum class NegativeCurvature {
  stop,  ///< keep the solution so far: a descent direction (Steihaug 1983)
  pass,  ///< continue: solve the system whatever its definiteness
};

struct LinearSettings {
  /// Stop at √(rᵀP⁻¹r) ≤ tolerance · its value for x = 0.
  double tolerance = 1e-6;
  double enough = 0;  ///< or where √(rᵀP⁻¹r) itself is at most this (PcgSolver only)
  int max_iterations = 10000;
  NegativeCurvature negative_curvature = NegativeCurvature::stop;
};

struct LinearReport {
  int iterations = 0;
  bool converged = false;
  bool negative_curvature = false;  ///< stopped there
  double relative_residual = 1;
};

/// Solves H s = b for the Hessian H at x. `residual` receives b − H s from the recurrence. If the first
/// direction has negative curvature, s = P⁻¹ b, which is steepest descent in the preconditioner's metric.
LinearReport conjugate_gradient(const IncrementalPotential& function, ConstVectors x,
                                const Preconditioner& preconditioner, ConstVectors b,
                                const LinearSettings& settings, Vectors s, Vectors residual);

}  // namespace muslin
