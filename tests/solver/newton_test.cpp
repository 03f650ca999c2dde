// Implicit steps as minimisation: against a dense reference, on crumpled sheets, at the limit of double, with
// moved and unreachable targets, and the same bits for any thread count.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "support/flag.hpp"
#include "support/potential_battery.hpp"
#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"
#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {
namespace {

/// Newton on the dense Hessian with Eigen's LDLT, made positive definite by a multiple of the masses where
/// needed: slow and independent of everything in solver/ but the function's value and derivatives.
std::vector<Vec3> dense_minimum(const IncrementalPotential& function, std::vector<Vec3> x) {
  const std::size_t count = x.size();
  const auto size = static_cast<Eigen::Index>(3 * count);
  std::vector<Vec3> g(count), column(count), unit(count, Vec3::Zero());
  for (int iteration = 0; iteration < 200; ++iteration) {
    function.gradient(x, g);
    if (function.imbalance(g).largest < 1e-9) return x;
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(size);
    for (std::size_t v = 0; v < count; ++v) {
      for (int c = 0; c < 3; ++c) {
        const auto row = static_cast<Eigen::Index>(3 * v) + c;
        if (function.held(v)) {
          h(row, row) = 1;
          continue;
        }
        unit[v][c] = 1;
        function.hessian_product(x, unit, column);
        unit[v][c] = 0;
        for (std::size_t w = 0; w < count; ++w) {
          h.block<3, 1>(static_cast<Eigen::Index>(3 * w), row) = column[w];
        }
        rhs[row] = -g[v][c];
      }
    }
    double shift = 0;
    Eigen::LDLT<Eigen::MatrixXd> factor(h);
    while (!factor.isPositive()) {
      shift = shift == 0 ? 1 : 4 * shift;
      factor.compute(h + shift * Eigen::MatrixXd::Identity(size, size));
    }
    const Eigen::VectorXd s = factor.solve(rhs);
    double t = 1;
    std::vector<Vec3> trial = x;
    const double before = function.value(x).value;
    for (; t > 1e-12; t /= 2) {
      for (std::size_t v = 0; v < count; ++v) {
        if (!function.held(v)) trial[v] = x[v] + t * s.segment<3>(static_cast<Eigen::Index>(3 * v));
      }
      if (function.value(trial).value <= before + 1e-14 * std::abs(before)) break;
    }
    x = trial;
  }
  ADD_FAILURE() << "the dense reference did not converge";
  return x;
}

TEST(ImplicitEuler, AStepIsTheDenseReferencesToTolerance) {
  test::Flag flag;
  flag.hold_top_corners();
  SolverSettings settings;
  settings.tolerance = 1e-8;
  const double dt = 1.0 / 240;
  for (int n = 0; n < 10; ++n) ASSERT_TRUE(flag.step(settings, dt).converged);
  for (int n = 0; n < 3; ++n) {
    const StepProblem problem = flag.problem();
    const std::vector<Vec3> prediction = test::sum(flag.state.positions, dt, flag.state.velocities);
    const IncrementalPotential function(problem, prediction, dt);
    const std::vector<Vec3> reference = dense_minimum(function, flag.state.positions);
    const StepReport report = flag.step(settings, dt);
    ASSERT_TRUE(report.converged) << report.failure;
    std::vector<Vec3> g(flag.rest.size());
    function.gradient(flag.state.positions, g);
    EXPECT_NEAR(function.imbalance(g).largest, report.residual, 1e-12) << "the residual reported is true";
    // 1e-8 of what gravity moves in a step is 2e-12 m.
    EXPECT_LE(test::norm(test::sum(flag.state.positions, -1, reference)), 1e-9);
  }
}

TEST(ImplicitEuler, CrumpledSheetsConvergeAtLargeSteps) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    test::Flag flag({20, 20, 1});
    flag.hold_top_corners();
    const double size = 0.2 * seed;
    flag.state.positions = test::sum(flag.rest, 1, test::random_vectors(flag.rest.size(), size, seed));
    for (std::size_t v = 0; v < flag.rest.size(); ++v) {
      if (flag.fixed[v] != 0) flag.state.positions[v] = flag.targets[v];
    }
    SolverSettings settings;
    int newton = 0;
    for (int n = 0; n < 5; ++n) {
      const StepReport report = flag.step(settings, 1.0 / 24);
      ASSERT_TRUE(report.converged) << "size " << size << ", step " << n << ": " << report.failure
                                    << ", residual " << report.residual;
      newton += report.newton_iterations;
      ASSERT_TRUE(std::isfinite(test::norm(flag.state.positions)));
    }
    RecordProperty("newton_iterations_" + std::to_string(seed), newton);
  }
}

TEST(ImplicitEuler, ManyLargeStepsOfTheFlagConvergeForBothIntegrators) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2}) {
    test::Flag flag;
    flag.hold_top_corners();
    SolverSettings settings;
    settings.integrator = integrator;
    for (int n = 0; n < 100; ++n) {
      const StepReport report = flag.step(settings, 1.0 / 24);
      ASSERT_TRUE(report.converged) << "step " << n << ": " << report.failure << " " << report.residual;
    }
    // It hangs below its corners and has come no further down than a taut flag could.
    EXPECT_LT(flag.at(5, 0, 0).y(), flag.at(0, 6, 0).y());
    EXPECT_GT(flag.at(5, 0, 0).y(), -8);
  }
}

TEST(ImplicitEuler, StiffMaterialsEndAtTheRoundingFloorInsteadOfStalling) {
  // Steel-like: rounding a position of 10 m alone changes the acceleration by about 1e-4 m/s².
  test::Flag flag({10, 6, 1}, {2e12, 2e12, 2e12});
  flag.hold_top_corners();
  SolverSettings settings;
  settings.tolerance = 1e-9;
  for (int n = 0; n < 5; ++n) {
    const StepReport report = flag.step(settings, 1.0 / 24);
    ASSERT_TRUE(report.converged) << report.failure << ", residual " << report.residual;
    EXPECT_LE(report.residual, 0.1) << "the true residual, not the tolerance";
  }
}

TEST(ImplicitEuler, HeldVerticesEndAtTheirTargetsAndHaveTheirVelocity) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2,
                                      Integrator::linearly_implicit_euler, Integrator::symplectic_euler}) {
    test::Flag flag;
    flag.hold_top_corners();
    SolverSettings settings;
    settings.integrator = integrator;
    const double dt = 1e-3;
    for (int n = 0; n < 20; ++n) {
      for (Vec3& target : flag.targets) target.z() += 0.5 * dt;
      ASSERT_TRUE(flag.step(settings, dt).converged);
    }
    for (std::size_t v = 0; v < flag.rest.size(); ++v) {
      if (flag.fixed[v] == 0) continue;
      EXPECT_EQ(flag.state.positions[v], flag.targets[v]);
      EXPECT_LE((flag.state.velocities[v] - Vec3(0, 0, 0.5)).norm(), 1e-9);
    }
  }
}

TEST(ImplicitEuler, AllHeldAndFreeFlightAreTrivial) {
  test::Flag held;
  held.hold([](const Vec3i&) { return true; });
  EXPECT_TRUE(held.step({}, 0.01).converged);
  EXPECT_EQ(held.state.positions, held.rest);
  test::Flag falling;
  SolverSettings settings;
  settings.tolerance = 1e-8;
  for (int n = 0; n < 10; ++n) ASSERT_TRUE(falling.step(settings, 0.01).converged);
  for (std::size_t v = 0; v < falling.rest.size(); ++v) {
    EXPECT_NEAR(falling.state.positions[v].y() - falling.rest[v].y(), -9.8 * 1e-4 * 55, 1e-9);
  }
}

/// W = −p Σ log(height − y): infinite at the ceiling y = height, and no way around.
class Ceiling : public Potential {
 public:
  explicit Ceiling(double height) : height_(height) {}
  double value(ConstVectors x) const override {
    double w = 0;
    for (const Vec3& p : x) w -= p.y() < height_ ? std::log(height_ - p.y()) : -INFINITY;
    return w;
  }
  void add_gradient(ConstVectors x, Vectors g) const override {
    for (std::size_t v = 0; v < x.size(); ++v) g[v].y() += 1 / (height_ - x[v].y());
  }
  void add_hessian_product(ConstVectors x, ConstVectors p, Vectors y) const override {
    for (std::size_t v = 0; v < x.size(); ++v) y[v].y() += p[v].y() / std::pow(height_ - x[v].y(), 2);
  }
  void add_diagonal_blocks(ConstVectors x, std::span<Mat3> blocks) const override {
    for (std::size_t v = 0; v < x.size(); ++v) blocks[v](1, 1) += std::pow(height_ - x[v].y(), -2);
  }
  double max_step(ConstVectors x, ConstVectors d) const override {
    double t = INFINITY;
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (d[v].y() > 0) t = std::min(t, (height_ - x[v].y()) / d[v].y());
    }
    return t;
  }

 private:
  double height_;
};

TEST(ImplicitEuler, NeverExceedsTheLimitOfAPotential) {
  test::Flag flag;
  const Ceiling ceiling(6.5);
  test::expect_potential_is_sound(ceiling, flag.rest, 0.5);
  flag.state.velocities.assign(flag.rest.size(), Vec3(0, 100, 0));
  SolverSettings settings;
  settings.effort = Effort::exact;
  double highest = 0;
  for (int n = 0; n < 10; ++n) {
    StepProblem problem = flag.problem();
    problem.potentials.push_back(&ceiling);
    const StepContext context = step_context(settings.integrator, flag.state, 0.02);
    const StepReport report = solve_step(settings, context, problem, flag.state);
    ASSERT_TRUE(report.converged) << report.failure;
    for (const Vec3& p : flag.state.positions) highest = std::max(highest, p.y());
  }
  EXPECT_LT(highest, 6.5);
  EXPECT_GT(highest, 6.4) << "it did hit the ceiling";
}

TEST(ImplicitEuler, TargetBeyondTheLimitOfAPotentialFailsWithAReason) {
  test::Flag flag;
  flag.hold_top_corners();
  for (Vec3& target : flag.targets) target.y() += 1;
  const Ceiling ceiling(6.5);
  StepProblem problem = flag.problem();
  problem.potentials.push_back(&ceiling);
  const State before = flag.state;
  const StepReport report =
      solve_step({}, step_context(Integrator::implicit_euler, flag.state, 0.02), problem, flag.state);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.failure.find("held vertices"), std::string::npos) << report.failure;
  EXPECT_EQ(flag.state.positions, before.positions);
}

TEST(ImplicitEuler, EndsAtOnceIfFloatLosesTheMasses) {
  for (const bool in_double : {true, false}) {
    test::Flag flag;
    flag.hold_top_corners();
    StepProblem problem = flag.problem();
    problem.in_double = in_double;
    const StepReport report =
        solve_step({}, step_context(Integrator::implicit_euler, flag.state, 60), problem, flag.state);
    EXPECT_TRUE(report.made());
    if (in_double) {
      EXPECT_GT(report.newton_iterations, 0);
    } else {
      EXPECT_FALSE(report.converged);
      EXPECT_EQ(report.newton_iterations, 0);
    }
  }
}

/// A potential that is never a number.
class Cliff : public test::Wells {
 public:
  Cliff() : Wells(0) {}
  double value(ConstVectors) const override { return std::numeric_limits<double>::quiet_NaN(); }
};

TEST(ImplicitEuler, NonFinitePotentialFailsAndDoesNotChangeTheState) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2}) {
    test::Flag flag;
    const State before = flag.state;
    const Cliff cliff;
    StepProblem problem = flag.problem();
    problem.potentials.push_back(&cliff);
    SolverSettings settings;
    settings.integrator = integrator;
    const StepReport report =
        solve_step(settings, step_context(integrator, flag.state, 0.01), problem, flag.state);
    EXPECT_FALSE(report.converged);
    EXPECT_FALSE(report.failure.empty());
    EXPECT_EQ(flag.state.positions, before.positions);
    EXPECT_EQ(flag.state.step, 0);
  }
}

TEST(Solver, SameBitsOnOneThreadAndOnTwo) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2,
                                      Integrator::linearly_implicit_euler, Integrator::symplectic_euler}) {
    std::vector<Vec3> positions[2];
    for (const int threads : {1, 2}) {
      set_thread_count(threads);
      test::Flag flag({60, 40, 1});  // more vertices than one block of any loop
      flag.hold_top_corners();
      flag.state.velocities = test::random_vectors(flag.rest.size(), 1, 9);
      SolverSettings settings;
      settings.integrator = integrator;
      for (int n = 0; n < 2; ++n) ASSERT_TRUE(flag.step(settings, 1.0 / 240).converged);
      positions[threads - 1] = flag.state.positions;
    }
    set_thread_count(0);
    EXPECT_EQ(0, std::memcmp(positions[0].data(), positions[1].data(), positions[0].size() * sizeof(Vec3)));
  }
}

}  // namespace
}  // namespace muslin
