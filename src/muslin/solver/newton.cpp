#include "muslin/solver/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "muslin/core/stopwatch.hpp"
#include "muslin/solver/conjugate_gradient.hpp"
#include "muslin/solver/preconditioner.hpp"
#include "muslin/solver/rigid_correction.hpp"
#include "muslin/solver/step_error.hpp"
#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

constexpr double armijo = 1e-4;
constexpr double slope_share = 0.9;  // approximate Wolfe: the slope must have risen above −0.9 of the first
constexpr double rounding = 1e-12;   // values closer than this (relative) cannot be told apart reliably
constexpr double smallest_step = 1e-8;
constexpr double loosest_forcing = 0.1, tightest_forcing = 1e-4;
/// Shells use this share of the tolerance, within bounds. With looser solves small buckles develop
/// differently.
constexpr double forcing_share = 0.25, tightest_of_shells = 0.05, loosest_of_shells = 0.2;
/// A step that has not converged after this many iterations is repeated in halves, or accepted and reported.
constexpr int max_iterations = 30, max_exact_iterations = 300;

/// Linear iterations after which float has lost the solution to rounding.
constexpr int max_in_float = 1000;

/// Iterations in which friction is lagged at the iterate. Later the minimum would move with the iterates and
/// not be reached.
constexpr int renewals = 3;
/// Iterations after which the Hessian of friction is the tangent in every other, unless the last step was
/// shortened.
constexpr int tangent_from = 6;

/// Iterations in which held vertices that are behind their targets push obstacles.
constexpr int max_pushes = 6;

class Newton {
 public:
  Newton(const StepProblem& problem, const IncrementalPotential& function, const SolverSettings& settings,
         const State& state, double length, Vectors x, NewtonWorkspace& workspace)
      : problem_(problem),
        function_(function),
        state_(state),
        length_(length),
        guard_(problem.guard),
        x_(x),
        workspace_(workspace),
        pcg_(workspace.pcg),
        g_(workspace.g),
        s_(workspace.s),
        d_(workspace.d),
        there_(workspace.x),
        count_(x.size()),
        scale_(function.dt() * function.dt()),
        tolerance_(settings.error_tolerance()),
        error_(problem, function, tolerance_),
        max_iterations_(settings.effort == Effort::exact ? max_exact_iterations : max_iterations),
        with_contact_(problem) {
    for (auto* vectors : {&there_, &g_, &s_, &d_, &workspace.base}) vectors->resize(count_);
    with_contact_.potentials.push_back(nullptr);
  }

  StepReport run() {
    if (!start()) {
      report_.failure = "the held vertices cannot reach their targets in this step";
      return report_;
    }
    pcg_.begin_step();
    evaluate();
    // Bodies in free fall move exactly from the first step on, although linear solves are loose.
    if (state_.previous_velocities.empty() && std::isfinite(imbalance_.norm)) {
      correct_rigid_motions();
      evaluate();
    }
    while (iterate()) continue;
    report_.residual = imbalance_.largest;
    report_.worst_vertex = imbalance_.vertex;
    report_.held_back = held_back_;
    if (report_.made() && report_.newton_iterations > 0)
      correct_work(problem_, full(), guard_, state_.positions, g_, x_);
    if (report_.made()) correct_rigid_motions();
    return report_;
  }

 private:
  IncrementalPotential full() const {
    return guard_ ? IncrementalPotential(with_contact_, function_.prediction(), function_.dt()) : function_;
  }

  /// Fills d_ with the displacement to `free(v)`, of held vertices to their targets.
  template <class Free>
  double aim(const Free& free) {
    for_each_vertex(count_, [&](std::size_t v) {
      there_[v] = function_.held(v) ? problem_.targets[v] : Vec3(free(v));
      d_[v] = there_[v] - state_.positions[v];
    });
    return function_.value(there_).value;
  }

  /// False if held vertices cannot follow, or no start has a finite value.
  bool start() {
    const auto inertial = [&](std::size_t v) { return function_.prediction()[v]; };
    bool extrapolated = false;
    if (!state_.previous_velocities.empty() && state_.previous_dt > 0) {
      const double change = length_ / state_.previous_dt;
      const double goes_on = aim([&](std::size_t v) {
        return Vec3(state_.positions[v] +
                    length_ * (state_.velocities[v] +
                               change * (state_.velocities[v] - state_.previous_velocities[v])));
      });
      std::swap(d_, s_);
      extrapolated = goes_on < aim(inertial);
      if (extrapolated) std::swap(d_, s_);
    } else {
      aim(inertial);
    }
    const double safe = function_.max_step(x_, d_);
    if (!(safe >= 1)) {
      for_each_vertex(count_, [&](std::size_t v) {
        if (!function_.held(v)) d_[v] *= 0.9 * safe;
      });
      if (function_.max_step(x_, d_) < 1) return false;
    }
    if (!all_finite(d_)) return false;
    if (guard_) {
      guard_->advance(x_, d_);
    } else {
      add(1, d_, x_);
    }
    held_back_ = snap_to_targets(problem_, x_);
    return true;
  }

  /// Has no effect if a potential does not allow the motion.
  void correct_rigid_motions() {
    std::copy(x_.begin(), x_.end(), there_.begin());
    muslin::correct_rigid_motions(problem_, function_, guard_, g_, x_);
    for_each_vertex(count_, [&](std::size_t v) { d_[v] = x_[v] - there_[v]; });
    if (!(function_.max_step(there_, d_) > 1)) std::copy(there_.begin(), there_.end(), x_.begin());
  }

  /// Evaluates everything at x_, with contact lagged there.
  void evaluate() {
    at_ = function_.evaluate(x_, workspace_.base);
    take_contact();
  }

  void take_contact() {
    imbalance_ = at_.imbalance;
    if (!guard_) {
      std::swap(g_, workspace_.base);
      return;
    }
    contact_ = &guard_->potential(x_, friction());
    with_contact_.potentials.back() = contact_;
    set_zero(g_);
    contact_value_ = contact_->add_gradient_and_value(x_, g_);
    for_each_vertex(count_, [&](std::size_t v) {
      g_[v] = function_.held(v) ? Vec3(Vec3::Zero()) : Vec3(workspace_.base[v] + scale_ * g_[v]);
    });
    imbalance_ = function_.imbalance(g_);
  }

  /// The tangent overshoots far from the minimum; near it the secant takes many iterations. Taken in turns,
  /// the secant ends the cycles into which the tangent may fall.
  StepGuard::Friction friction() const {
    const int n = report_.newton_iterations;
    if (n < renewals) return StepGuard::Friction::anew;
    const bool is_near = n >= tangent_from && n % 2 == 0 && length_t_ == 1;
    return is_near ? StepGuard::Friction::kept_tangent : StepGuard::Friction::kept;
  }

  /// One iteration; false when the step has ended.
  bool iterate() {
    if (!std::isfinite(imbalance_.norm) || !std::isfinite(at_.value.value)) {
      report_.failure = "forces are not finite numbers";
      return false;
    }
    if (report_.newton_iterations == 0 && held_back_ == 0 && error_.bound(x_, g_)) return done(true);
    if (report_.newton_iterations == max_iterations_) return done(false);
    if (report_.newton_iterations > 0 && report_.newton_iterations <= max_pushes && held_back_ > 0)
      push_held();
    {
      const Stopwatch watch(report_.linearize_seconds);
      pcg_.linearize(full(), x_);
    }
    if (!problem_.in_double && !pcg_.fits_float()) return done(false);
    if (report_.newton_iterations == 0) forcing_ = loosest();
    if (imbalance_.largest <= function_.rounding_floor(x_, pcg_.stiffest())) return done(true);
    ++report_.newton_iterations;
    pcg_.precondition(g_, there_);
    error_.begin(g_, there_);
    const double norm = imbalance_.norm;
    if (!move() && !(pcg_.project() && move())) {
      error_.give_up(s_);
      return done(false);
    }
    pcg_.precondition(g_, there_);
    const bool good = error_.end(x_, state_.positions, g_, there_, s_, d_, length_t_);
    const double shrink = imbalance_.norm / norm;
    forcing_ =
        std::clamp(std::max(0.9 * shrink * shrink, error_.wanted_forcing()), tightest_forcing, loosest());
    return good ? done(true) : true;
  }

  /// Springs that buckle make H indefinite. Then loose solves make no progress, and tight steps need tight
  /// solves.
  double loosest() const {
    return pcg_.has_springs() ? std::clamp(tolerance_, tightest_forcing, loosest_forcing)
                              : std::clamp(forcing_share * tolerance_, tightest_of_shells, loosest_of_shells);
  }

  bool done(bool converged) {
    report_.converged = converged;
    report_.error = error_.largest();
    return false;
  }

  /// Moves held vertices that are behind their targets, pushing obstacles.
  void push_held() {
    for_each_vertex(count_, [&](std::size_t v) {
      d_[v] = function_.held(v) ? Vec3(problem_.targets[v] - x_[v]) : Vec3(Vec3::Zero());
    });
    guard_->limit(x_, d_);
    add(1, d_, x_);
    held_back_ = snap_to_targets(problem_, x_);
    evaluate();
  }

  /// Solves for a step and moves along it as far as that is safe and the value decreases.
  bool move() {
    LinearSettings linear;
    linear.tolerance = forcing_;
    {
      const Stopwatch watch(report_.solve_seconds);
      report_.linear_iterations += solve_linear(full(), x_, g_, linear, pcg_, s_).iterations;
    }
    for_each_vertex(count_, [&](std::size_t v) { s_[v] = -s_[v]; });
    return all_finite(s_) && search();
  }

  double limited(double share) {
    for_each_vertex(
        count_, [&](std::size_t v) { d_[v] = function_.held(v) ? Vec3(Vec3::Zero()) : Vec3(share * s_[v]); });
    if (guard_) guard_->limit(x_, d_);
    return dot(g_, d_);
  }

  bool search() {
    double slope = limited(1);
    // A limited step may be an ascent direction: a shorter one is limited less.
    for (double share = 0.5; !(slope < 0); share *= 0.5) {
      if (!guard_ || share < smallest_step) return false;
      slope = limited(share);
    }
    const double longest = std::min(1.0, 0.9 * function_.max_step(x_, d_));
    const double before = at_.value.value + scale_ * contact_value_;
    const double allowance = rounding * (at_.value.magnitude + scale_ * std::abs(contact_value_));
    for (double t = longest; t > smallest_step;) {
      combine(x_, t, d_, there_);
      const double contact = contact_ ? contact_->value(there_) : 0;
      bool have_gradient = t == longest || guard_;
      IncrementalPotential::Evaluation tried;
      if (have_gradient) {
        tried = function_.evaluate(there_, workspace_.base);
      } else {
        tried.value = function_.value(there_);
      }
      const double change = tried.value.value + scale_ * contact - before;
      bool accepted = change <= armijo * t * slope;
      if (!accepted && std::abs(change) <= allowance) {
        if (!have_gradient) tried = function_.evaluate(there_, workspace_.base);
        have_gradient = true;
        accepted = guard_ || std::abs(dot(workspace_.base, d_)) <= slope_share * std::abs(slope);
      }
      if (accepted && std::isfinite(tried.value.value)) {
        if (!have_gradient) tried = function_.evaluate(there_, workspace_.base);
        if (!std::isfinite(tried.imbalance.norm)) return false;
        std::copy(there_.begin(), there_.end(), x_.begin());
        at_ = tried;
        length_t_ = t;
        take_contact();
        return true;
      }
      // The minimum of the parabola through value and slope at 0 and the value at t, kept within bounds.
      const double parabola = -0.5 * slope * t * t / (change - t * slope);
      t = std::isfinite(change) && std::isfinite(parabola) ? std::clamp(parabola, 0.1 * t, 0.5 * t) : 0.1 * t;
    }
    return false;
  }

  const StepProblem& problem_;
  const IncrementalPotential& function_;
  const State& state_;
  double length_;  ///< of the step [s]
  StepGuard* guard_;
  Vectors x_;
  NewtonWorkspace& workspace_;
  PcgSolver& pcg_;
  std::vector<Vec3>&g_, &s_, &d_, &there_;
  std::size_t count_;
  double scale_;
  double tolerance_;
  StepError error_;
  int max_iterations_;
  StepProblem with_contact_;
  StepReport report_;
  IncrementalPotential::Evaluation at_;        ///< at x, without contact
  IncrementalPotential::Imbalance imbalance_;  ///< at x, of everything
  const Potential* contact_ = nullptr;
  double contact_value_ = 0;
  double forcing_ = 0;
  double length_t_ = 1;  ///< the share of d_ that was gone
  int held_back_ = 0;
};

}  // namespace

LinearReport solve_linear(const IncrementalPotential& function, ConstVectors x, ConstVectors b,
                          const LinearSettings& settings, PcgSolver& pcg, Vectors s) {
  int wasted = 0;
  if (pcg.fits_float()) {
    double norm;
    LinearSettings in_float = settings;
    in_float.max_iterations = max_in_float;
    const LinearReport report = pcg.solve(b, in_float, s, norm);
    if (report.converged || report.negative_curvature) return report;
    wasted = report.iterations;
  }
  std::vector<Mat3> blocks(b.size());
  std::vector<Vec3> residual(b.size());
  function.diagonal_blocks(x, blocks);
  LinearReport report =
      conjugate_gradient(function, x, BlockJacobi(function, blocks), b, settings, s, residual);
  report.iterations += wasted;
  return report;
}

std::size_t NewtonWorkspace::bytes() const {
  std::size_t vectors = 0;
  for (const auto* v : {&x, &g, &s, &base, &d, &end}) vectors += v->capacity();
  return vectors * sizeof(Vec3) + pcg.bytes();
}

int snap_to_targets(const StepProblem& problem, Vectors x) {
  constexpr double near = 1e-14;
  int held_back = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (problem.fixed[v] == 0) continue;
    const Vec3& target = problem.targets[v];
    if (!problem.guard || (x[v] - target).cwiseAbs().maxCoeff() <= near * target.cwiseAbs().maxCoeff()) {
      x[v] = target;
    } else {
      ++held_back;
    }
  }
  return held_back;
}

StepReport minimize(const StepProblem& problem, const IncrementalPotential& function,
                    const SolverSettings& settings, const State& state, double length, Vectors x,
                    NewtonWorkspace& workspace) {
  return Newton(problem, function, settings, state, length, x, workspace).run();
}

}  // namespace muslin
