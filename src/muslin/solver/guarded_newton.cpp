#include "muslin/solver/guarded_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "muslin/core/stopwatch.hpp"
#include "muslin/solver/anderson.hpp"
#include "muslin/solver/vector_operations.hpp"

namespace muslin {
namespace {

constexpr double armijo = 1e-4;
constexpr double rounding = 1e-12;  // values closer than this (relative) cannot be told apart reliably
constexpr double smallest_step = 1e-6;
constexpr double loosest_forcing = 0.01, tightest_forcing = 1e-3;
/// Of fast steps: the last of the iterations that every step may make is solved for better than the first and
/// than those that are made because much moves, which others follow.
constexpr double fast_forcing = 0.05, loose_fast_forcing = 0.1;
/// A fast step ends early where its last motion was below the first share of the guard's resolution and left
/// no more than so much of the gradient, makes one iteration more where the motion was above the second, and
/// as many as so many more while it is above the third.
constexpr double calm_shrink = 0.3;
constexpr double calm_share = 0.02, restless_share = 0.1, wild_share = 0.15;
constexpr int restless_iterations = 4;
/// Iterations that Anderson's acceleration looks back over in a converged step, and those it leaves alone.
constexpr std::size_t mixed_iterations = 5;
constexpr int unmixed_iterations = 3;

class GuardedStep {
 public:
  GuardedStep(const StepProblem& problem, const IncrementalPotential& function,
              const SolverSettings& settings, const State& state, double length, Vectors x,
              NewtonWorkspace& workspace)
      : problem_(problem),
        function_(function),
        settings_(settings),
        state_(state),
        length_(length),
        guard_(*problem.guard),
        x_(x),
        workspace_(workspace),
        count_(x.size()),
        scale_(function.dt() * function.dt()),
        with_contact_(problem) {
    for (auto* vectors : {&workspace.x, &workspace.g, &workspace.s, &base_, &d_, &last_move_, &mixed_step_})
      vectors->resize(count_);
    with_contact_.potentials.push_back(nullptr);
  }

  StepReport run() {
    start();
    workspace_.inner.begin_step();
    StepReport report;
    const bool fast = settings_.effort == Effort::fast;
    const int most = fast ? settings_.fast_iterations + restless_iterations : settings_.max_iterations;
    for (;;) {
      if (report.newton_iterations > 0 && held_back_ > 0) push_held();
      find_gradient();
      IncrementalPotential::Imbalance imbalance = function_.imbalance(workspace_.g);
      if (mixed_ && !(imbalance.norm < norm_)) {
        take_back_mixing();
        imbalance = function_.imbalance(workspace_.g);
      }
      shrink_ = imbalance.norm / norm_;
      norm_ = imbalance.norm;
      report.residual = imbalance.largest;
      report.worst_vertex = imbalance.vertex;
      report.held_back = held_back_;
      if (!std::isfinite(imbalance.norm)) {
        report.failure = "forces are not finite numbers";
        break;
      }
      report.converged = imbalance.largest <= settings_.tolerance;
      if (report.converged) break;
      if (report.newton_iterations == most || (fast && is_calm(report.newton_iterations))) {
        if (!fast)
          report.failure =
              "the step is not in balance after " + std::to_string(most) + " Newton iterations under contact";
        break;
      }
      {
        const Stopwatch watch(report.linearize_seconds);
        workspace_.inner.linearize(full(), x_);
      }
      if (imbalance.largest <= function_.rounding_floor(x_, workspace_.inner.stiffest())) {
        report.converged = true;
        break;
      }
      LinearSettings linear;
      if (fast) {
        const bool last = report.newton_iterations + 1 == settings_.fast_iterations;
        linear.tolerance = last ? fast_forcing : loose_fast_forcing;
      } else {
        linear.tolerance =
            std::clamp(0.3 * settings_.tolerance / imbalance.largest, tightest_forcing, loosest_forcing);
      }
      ++report.newton_iterations;
      const auto try_to_move = [&] {
        {
          const Stopwatch watch(report.solve_seconds);
          report.linear_iterations +=
              solve_linear(full(), x_, workspace_.g, linear, workspace_.inner, workspace_.s).iterations;
        }
        for_each_vertex(count_, [&](std::size_t v) { workspace_.s[v] = -workspace_.s[v]; });
        return all_finite(workspace_.s) && move();
      };
      if (try_to_move() || (workspace_.inner.project() && try_to_move())) {
        if (!fast && report.newton_iterations > unmixed_iterations) mix();
        continue;
      }
      if (!fast) report.failure = "no step lowers the energy any further";
      break;
    }
    return report;
  }

 private:
  /// To where the motion goes on as in the last step, or to the inertial prediction if that is lower; held
  /// vertices to their targets.
  void start() {
    std::vector<Vec3>& there = workspace_.x;
    const auto set = [&](const auto& free) {
      for_each_vertex(
          count_, [&](std::size_t v) { there[v] = function_.held(v) ? problem_.targets[v] : Vec3(free(v)); });
      return function_.value(there).value;
    };
    const auto displacement = [&] {
      for_each_vertex(count_, [&](std::size_t v) { d_[v] = there[v] - x_[v]; });
    };
    const double inertial = set([&](std::size_t v) { return function_.prediction()[v]; });
    displacement();
    if (!state_.previous_velocities.empty() && state_.previous_dt > 0) {
      const double change = length_ / state_.previous_dt;
      const double goes_on = set([&](std::size_t v) {
        return Vec3(x_[v] + length_ * (state_.velocities[v] +
                                       change * (state_.velocities[v] - state_.previous_velocities[v])));
      });
      if (goes_on < inertial) displacement();
    }
    guard_.advance(x_, d_);
    held_back_ = land_held_vertices(problem_, x_);
    value_ = function_.value_and_gradient(x_, base_);
  }

  /// Moves held vertices that were held back on, pushing what is in their way.
  void push_held() {
    for_each_vertex(count_, [&](std::size_t v) {
      d_[v] = function_.held(v) ? Vec3(problem_.targets[v] - x_[v]) : Vec3(Vec3::Zero());
    });
    guard_.limit(x_, d_);
    add(1, d_, x_);
    held_back_ = land_held_vertices(problem_, x_);
    value_ = function_.value_and_gradient(x_, base_);
  }

  /// Of everything, contact lagged at x.
  void find_gradient() {
    contact_ = &guard_.potential(x_);
    with_contact_.potentials.back() = contact_;
    std::vector<Vec3>& g = workspace_.g;
    set_zero(g);
    contact_value_ = contact_->add_gradient_and_value(x_, g);
    for_each_vertex(count_, [&](std::size_t v) {
      g[v] = function_.held(v) ? Vec3(Vec3::Zero()) : Vec3(base_[v] + scale_ * g[v]);
    });
  }

  /// What is lagged makes Newton's method converge linearly: goes on to where the last iterations lead, as
  /// far as the guard lets. Whether that was good the next gradient tells.
  void mix() {
    mixed_ = mixing_.mix(x_, last_move_, mixed_step_);
    if (!mixed_) return;
    for_each_vertex(count_, [&](std::size_t v) {
      if (function_.held(v)) mixed_step_[v].setZero();
    });
    guard_.limit(x_, mixed_step_);
    add(1, mixed_step_, x_);
    value_ = function_.value_and_gradient(x_, base_);
  }

  /// The way that was safe there is safe back.
  void take_back_mixing() {
    mixed_ = false;
    mixing_.clear();
    for_each_vertex(count_, [&](std::size_t v) { x_[v] -= mixed_step_[v]; });
    value_ = function_.value_and_gradient(x_, base_);
    find_gradient();
  }

  /// Whether a fast step may end after so many iterations. Short ways may be long for contact: a vertex that
  /// rests lies as deep in it as its weight needs, which may be less than 1 µm, and the iteration that finds
  /// it just above knows nothing of contact. It would flutter for ever, and what flutters creeps.
  bool is_calm(int iterations) const {
    if (iterations == 0) return false;
    if (iterations < settings_.fast_iterations && (held_back_ > 0 || !(shrink_ <= calm_shrink))) return false;
    const double share = iterations < settings_.fast_iterations    ? calm_share
                         : iterations == settings_.fast_iterations ? restless_share
                                                                   : wild_share;
    return moved_ <= share * guard_.resolution();
  }

  IncrementalPotential full() const { return {with_contact_, function_.prediction(), function_.dt()}; }

  /// Moves x along the limited step as far as the energy falls; value_ and base_ with it.
  bool move() {
    const std::vector<Vec3>&g = workspace_.g, &s = workspace_.s;
    const auto limited = [&](double share) {
      for_each_vertex(count_, [&](std::size_t v) {
        d_[v] = function_.held(v) ? Vec3(Vec3::Zero()) : Vec3(share * s[v]);
      });
      guard_.limit(x_, d_);
      return dot(g, d_);
    };
    double slope = limited(1);
    for (double share = 0.5; !(slope < 0); share *= 0.5) {
      // What is left of the step leads uphill: a shorter one is limited less.
      if (share < smallest_step) return false;
      slope = limited(share);
    }
    const double before = value_.value + scale_ * contact_value_;
    const double allowance = rounding * (value_.magnitude + scale_ * std::abs(contact_value_));
    std::vector<Vec3>& there = workspace_.x;
    for (double t = 1; t > smallest_step;) {
      combine(x_, t, d_, there);
      const double contact = contact_->value(there);
      const IncrementalPotential::Value value = function_.value_and_gradient(there, base_);
      const double change = value.value + scale_ * contact - before;
      if (change <= armijo * t * slope || std::abs(change) <= allowance) {
        std::copy(there.begin(), there.end(), x_.begin());
        value_ = value;
        moved_ = 0;
        for (const Vec3& d : d_) moved_ = std::max(moved_, t * d.norm());
        for_each_vertex(count_, [&](std::size_t v) { last_move_[v] = t * d_[v]; });
        return true;
      }
      const double parabola = -0.5 * slope * t * t / (change - t * slope);
      t = std::isfinite(change) && std::isfinite(parabola) ? std::clamp(parabola, 0.1 * t, 0.5 * t) : 0.1 * t;
    }
    return false;
  }

  const StepProblem& problem_;
  const IncrementalPotential& function_;
  const SolverSettings& settings_;
  const State& state_;
  double length_;  ///< of the step [s]
  StepGuard& guard_;
  Vectors x_;
  NewtonWorkspace& workspace_;
  std::size_t count_;
  double scale_;
  StepProblem with_contact_;
  const Potential* contact_ = nullptr;
  IncrementalPotential::Value value_;  ///< at x, without contact
  double contact_value_ = 0;
  int held_back_ = 0;
  double moved_ = 0;            ///< by the vertex that the last iteration moved farthest [m]
  std::vector<Vec3> base_, d_;  ///< the gradient without contact; the limited step
  AndersonMixing mixing_{mixed_iterations};
  bool mixed_ = false;                                     ///< whether x is where mixing led
  double norm_ = std::numeric_limits<double>::infinity();  ///< of the last gradient
  double shrink_ = 0;                                      ///< its norm over that of the one before
  std::vector<Vec3> last_move_, mixed_step_;
};

}  // namespace

int land_held_vertices(const StepProblem& problem, Vectors x) {
  constexpr double near = 1e-14;
  int held_back = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (problem.fixed[v] == 0) continue;
    const Vec3& target = problem.targets[v];
    if ((x[v] - target).cwiseAbs().maxCoeff() <= near * target.cwiseAbs().maxCoeff()) {
      x[v] = target;
    } else {
      ++held_back;
    }
  }
  return held_back;
}

StepReport minimize_guarded(const StepProblem& problem, const IncrementalPotential& function,
                            const SolverSettings& settings, const State& state, double length, Vectors x,
                            NewtonWorkspace& workspace) {
  return GuardedStep(problem, function, settings, state, length, x, workspace).run();
}

}  // namespace muslin
