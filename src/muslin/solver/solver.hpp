// Time stepping: one step of an integrator over masses, potentials and held vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "muslin/core/vectors.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/potential/state.hpp"
#include "muslin/potential/step_guard.hpp"

namespace muslin {

enum class Integrator {
  implicit_euler,           ///< first order, unconditionally stable, damps
  bdf2,                     ///< second order, unconditionally stable, damps little
  linearly_implicit_euler,  ///< one Newton step on the exact tangent (Baraff and Witkin 1998)
  symplectic_euler,         ///< explicit, first order, conserves; stable only for small steps
};

/// How accurately a step of implicit_euler or bdf2 is solved.
enum class Effort {
  draft,   ///< to see whether a scene works
  normal,  ///< for pictures
  exact,   ///< for measurements
};

struct SolverSettings {
  Integrator integrator = Integrator::implicit_euler;
  Effort effort = Effort::normal;
  /// A step is done when the estimate of its error, as motion, is at most this share of the motion that the
  /// accelerations at work cause in a step: error ≤ tolerance · a · dt² in every part, and no more than that
  /// share of an edge. None: that of `effort`.
  std::optional<double> tolerance;
  double linear_tolerance = 1e-6;  ///< relative residual of the one linear solve of linearly_implicit_euler

  double error_tolerance() const {
    if (tolerance) return *tolerance;
    return effort == Effort::draft ? 1 : effort == Effort::normal ? 0.2 : 1e-3;
  }
};

/// One step's problem. `fixed[v]` is 1 where vertex v is held: it ends the step at targets[v], or, where a
/// guard does not let it, as near as it comes.
struct StepProblem {
  std::span<const double> masses;            ///< #V [kg]
  std::vector<const Potential*> potentials;  ///< all that act during this step
  std::span<const std::uint8_t> fixed;       ///< #V
  ConstVectors targets;                      ///< #V by 3 [m], read only where fixed
  StepGuard* guard = nullptr;                ///< whom to ask before anything moves; none if null
  /// #V by 3 [m], the same from step to step: what is near each other here moves alike. Without them no
  /// coarse space helps to solve for the smooth part of the motion.
  ConstVectors rest_positions = {};
  /// #V, the part of the model that each vertex belongs to, connected within; empty: all of one.
  std::span<const int> parts = {};
  std::span<const double> accelerations = {};  ///< by part, root mean square of what loads cause [m/s²]
  std::span<const double> edges = {};          ///< by part, typical distance of neighbours [m]
};

struct StepReport {
  bool converged = false;  ///< within the tolerance
  int newton_iterations = 0;
  int linear_iterations = 0;
  double residual = 0;                              ///< max ‖∂E/∂xᵢ‖ / (mᵢ dt²) [m/s²]
  double error = 0;                                 ///< estimate of how far from the minimum, as motion [m]
  int worst_vertex = -1;                            ///< where the residual is largest
  int held_back = 0;                                ///< held vertices that a guard keeps from their targets
  double linearize_seconds = 0, solve_seconds = 0;  ///< spent under a guard on Hessians and linear systems
  std::string failure;                              ///< why the step could not be made, empty otherwise

  bool made() const { return failure.empty(); }
};

/// What loads must know before the step of length dt from `state`.
StepContext step_context(Integrator integrator, const State& state, double dt);

/// Advances states step by step. Keeps its vectors between steps, so that steps of one size allocate little.
class Stepper {
 public:
  Stepper();
  ~Stepper();
  Stepper(Stepper&&) noexcept;
  Stepper& operator=(Stepper&&) noexcept;

  /// Advances `state` by one step. If the report says that it was not made, `state` is unchanged; it never
  /// holds NaN. With a guard: symplectic_euler is refused (Error(usage)); linearly_implicit_euler goes where
  /// its one iteration leads as far as the guard lets it.
  StepReport step(const SolverSettings& settings, const StepContext& context, const StepProblem& problem,
                  State& state);
  /// Memory held between steps.
  std::size_t bytes() const;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// One step by a Stepper of its own.
StepReport solve_step(const SolverSettings& settings, const StepContext& context, const StepProblem& problem,
                      State& state);

}  // namespace muslin
