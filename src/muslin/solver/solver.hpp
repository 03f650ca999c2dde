// Stepper advances masses, potentials and held vertices by steps of an integrator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "muslin/api.hpp"
#include "muslin/core/keyframes.hpp"
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

/// Accuracy to which a step of implicit_euler or bdf2 is solved.
enum class Effort {
  draft,   ///< to see whether a scene works
  normal,  ///< for pictures
  exact,   ///< for measurements
};

struct SolverSettings {
  /// An effort from a time on [s].
  struct EffortKey {
    double time = 0;
    Effort value = Effort::normal;
  };
  Integrator integrator = Integrator::implicit_euler;
  Effort effort = Effort::normal;
  std::vector<EffortKey> effort_keys;  ///< of an effort that changes, the first being `effort`; times ascend
  /// A step has converged when its error estimate, a displacement, is at most this share of the displacement
  /// that the acting accelerations cause in a step (error ≤ tolerance · a · dt² in every part) and at most
  /// this share of an edge. None: the tolerance of `effort`.
  std::optional<double> tolerance;
  double linear_tolerance = 1e-6;  ///< relative residual of the one linear solve of linearly_implicit_euler

  Effort effort_at(double time) const {
    return effort_keys.empty() ? effort : keyframes_around(effort_keys, time).from.value;
  }
  /// Returns the settings of a step that ends at `time` [s].
  SolverSettings at(double time) const {
    SolverSettings settings = *this;
    settings.effort = effort_at(time);
    return settings;
  }
  double error_tolerance() const {
    if (tolerance) return *tolerance;
    return effort == Effort::draft ? 1 : effort == Effort::normal ? 0.2 : 1e-3;
  }
};

/// The problem of one step. `fixed[v]` is 1 where vertex v is held: it ends the step at targets[v], or as
/// close as the guard allows.
struct StepProblem {
  std::span<const double> masses;            ///< #V [kg]
  std::vector<const Potential*> potentials;  ///< all that act during this step
  std::span<const std::uint8_t> fixed;       ///< #V
  ConstVectors targets;                      ///< #V by 3 [m], read only where fixed
  StepGuard* guard = nullptr;                ///< limits all motions; null: none
  /// #V by 3 [m], constant: vertices that are close here move alike. Without them the solver has no coarse
  /// space for the smooth part of the motion.
  ConstVectors rest_positions = {};
  /// #V, the connected part of the model that each vertex belongs to; empty: a single part.
  std::span<const int> parts = {};
  std::span<const double> accelerations = {};  ///< by part, root mean square, due to loads [m/s²]
  std::span<const double> edges = {};          ///< by part, typical distance of neighbours [m]
  /// True: linear systems in which float loses the masses against the stiffnesses are solved in double,
  /// slowly. False: a step with such a system ends without convergence; shorter steps may fit float.
  bool in_double = true;
  /// Those of `potentials` that damp: ½ (x − anchor)ᵀ C (x − anchor)/dt, with C the damping matrix.
  std::vector<const Potential*> dampings = {};
  /// Vertices outside of all bodies that are free nevertheless, and the springs that hold them, one of
  /// `potentials`. Their own error does not matter; that of the energy may be a share of what the springs
  /// hold.
  struct Yielding {
    std::span<const int> vertices;
    const Potential* springs = nullptr;  ///< null: there are no such vertices
  };
  Yielding yielding = {};
};

struct StepReport {
  bool converged = false;  ///< within the tolerance
  int newton_iterations = 0;
  int linear_iterations = 0;
  double residual = 0;                              ///< max ‖∂E/∂xᵢ‖ / (mᵢ dt²) [m/s²]
  double error = 0;                                 ///< estimated distance from the minimum [m]
  int worst_vertex = -1;                            ///< where the residual is largest
  int held_back = 0;                                ///< held vertices that the guard keeps from their targets
  double linearize_seconds = 0, solve_seconds = 0;  ///< on Hessians, on linear systems
  std::string failure;                              ///< the reason if the step could not be made, else empty

  bool made() const { return failure.empty(); }
};

/// Returns the data for loads before the step of length dt from `state`.
MUSLIN_API StepContext step_context(Integrator integrator, const State& state, double dt);

/// Advances states step by step. Keeps its vectors between steps to avoid allocations.
class MUSLIN_API Stepper {
 public:
  Stepper();
  ~Stepper();
  Stepper(Stepper&&) noexcept;
  Stepper& operator=(Stepper&&) noexcept;

  /// Advances `state` by one step. If the report has a failure, `state` is unchanged; it never contains NaN.
  /// With a guard: symplectic_euler is refused (Error(usage)); the one iteration of linearly_implicit_euler
  /// is limited by the guard.
  StepReport step(const SolverSettings& settings, const StepContext& context, const StepProblem& problem,
                  State& state);
  /// Returns the memory held between steps.
  std::size_t bytes() const;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// Advances one step with a temporary Stepper.
MUSLIN_API StepReport solve_step(const SolverSettings& settings, const StepContext& context,
                                 const StepProblem& problem, State& state);

}  // namespace muslin
