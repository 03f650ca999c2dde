// Preconditioned conjugate gradients for the Hessian of the incremental potential, which need not be
// positive definite.
#pragma once

#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/preconditioner.hpp"

namespace muslin {

enum class NegativeCurvature {
  stop,  ///< keep what has been found so far: a descent direction (Steihaug 1983)
  pass,  ///< go on: the solution of the system is wanted, whatever its definiteness
};

struct LinearSettings {
  /// Stop at √(rᵀP⁻¹r) ≤ tolerance · its value for x = 0.
  double tolerance = 1e-6;
  double enough = 0;  ///< nor go on where √(rᵀP⁻¹r) itself is at most this (InnerSolver only)
  int max_iterations = 10000;
  NegativeCurvature negative_curvature = NegativeCurvature::stop;
};

struct LinearReport {
  int iterations = 0;
  bool converged = false;
  bool negative_curvature = false;  ///< stopped there
  double relative_residual = 1;
};

/// Solves H s = b for the Hessian H at x. `residual` receives b − H s as the recurrence has it. If the very
/// first direction has negative curvature, s = P⁻¹ b: steepest descent in the preconditioner's metric.
LinearReport conjugate_gradient(const IncrementalPotential& function, ConstVectors x,
                                const Preconditioner& preconditioner, ConstVectors b,
                                const LinearSettings& settings, Vectors s, Vectors residual);

}  // namespace muslin
