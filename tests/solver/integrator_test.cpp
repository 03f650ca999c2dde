// Integrators against closed forms, and their orders of convergence as measured.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/flag.hpp"
#include "support/simple_potentials.hpp"
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "muslin/potential/mass_damping.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {
namespace {

/// One vertex under the given potentials.
struct Particle {
  std::vector<double> masses{1};
  std::vector<std::uint8_t> fixed{0};
  std::vector<Vec3> targets{Vec3::Zero()};
  State state;

  explicit Particle(const Vec3& x, const Vec3& v = Vec3::Zero()) {
    state.positions = {x};
    state.velocities = {v};
  }
  StepReport step(const SolverSettings& settings, double dt, const Potential& potential,
                  const Load* load = nullptr) {
    const StepContext context = step_context(settings.integrator, state, dt);
    const auto acting = load != nullptr ? load->potential(context) : nullptr;
    StepProblem problem{masses, {&potential}, fixed, targets};
    if (acting) {
      problem.potentials.push_back(acting.get());
      problem.dampings.push_back(acting.get());
    }
    return solve_step(settings, context, problem, state);
  }
};

SolverSettings tight(Integrator integrator) {
  SolverSettings settings;
  settings.integrator = integrator;
  settings.tolerance = 1e-9;
  settings.linear_tolerance = 1e-13;
  return settings;
}

class FirstOrderImplicit : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Integrators, FirstOrderImplicit,
                         testing::Values(Integrator::implicit_euler, Integrator::linearly_implicit_euler));

TEST_P(FirstOrderImplicit, FreeFallDropsByGDtDtNTimesNPlusOneOverTwo) {
  Particle particle(Vec3(0, 0, 0));
  const test::UniformGravity gravity({1}, Vec3(0, -9.8, 0));
  const double dt = 0.01;
  for (int n = 1; n <= 100; ++n) {
    ASSERT_TRUE(particle.step(tight(GetParam()), dt, gravity).converged);
    EXPECT_NEAR(particle.state.positions[0].y(), -9.8 * dt * dt * n * (n + 1) / 2, 1e-11);
    EXPECT_NEAR(particle.state.velocities[0].y(), -9.8 * dt * n, 1e-9);
  }
  EXPECT_NEAR(particle.state.time, 1, 1e-12);
  EXPECT_EQ(particle.state.step, 100);
}

TEST_P(FirstOrderImplicit, OscillatorDecaysByOneOverRootOnePlusOmegaDtSquared) {
  const double omega = 20;
  const double dt = 0.02;
  Particle particle(Vec3(1, 0, 0));
  const test::Wells well(omega * omega);
  const auto amplitude = [&] {
    return std::hypot(particle.state.positions[0].x(), particle.state.velocities[0].x() / omega);
  };
  for (int n = 0; n < 50; ++n) {
    const double before = amplitude();
    ASSERT_TRUE(particle.step(tight(GetParam()), dt, well).converged);
    EXPECT_NEAR(amplitude() / before, 1 / std::sqrt(1 + omega * omega * dt * dt), 1e-9);
  }
}

/// Error at t = 1 s of an oscillator with 1 s⁻¹ drag, halving dt from 1/100.
std::vector<double> oscillator_errors(Integrator integrator, int halvings) {
  const double omega = 5;
  const double alpha = 1;
  const double damped = std::sqrt(omega * omega - alpha * alpha / 4);
  const double exact = std::exp(-alpha / 2) * (std::cos(damped) + alpha / (2 * damped) * std::sin(damped));
  const MassDamping drag(alpha, {1});
  const test::Wells well(omega * omega);
  std::vector<double> errors;
  for (int h = 0; h < halvings; ++h) {
    const int steps = 100 << h;
    Particle particle(Vec3(1, 0, 0));
    for (int n = 0; n < steps; ++n) {
      EXPECT_TRUE(particle.step(tight(integrator), 1.0 / steps, well, &drag).converged);
    }
    errors.push_back(std::abs(particle.state.positions[0].x() - exact));
  }
  return errors;
}

struct Order {
  Integrator integrator;
  double order;
};
class OrderOfConvergence : public testing::TestWithParam<Order> {};

TEST_P(OrderOfConvergence, IsThatOfTheTextbook) {
  const std::vector<double> errors = oscillator_errors(GetParam().integrator, 4);
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), GetParam().order, 0.15) << "halving " << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Integrators, OrderOfConvergence,
                         testing::Values(Order{Integrator::implicit_euler, 1}, Order{Integrator::bdf2, 2},
                                         Order{Integrator::linearly_implicit_euler, 1},
                                         Order{Integrator::symplectic_euler, 1}));

TEST(Bdf2, KeepsItsOrderWhenTheStepChanges) {
  const test::Wells well(25);
  std::vector<double> errors;
  for (int h = 0; h < 4; ++h) {
    const double dt = 0.01 / (1 << h);
    Particle particle(Vec3(1, 0, 0));
    double largest = 0;
    // Long and short steps in turn: dt, dt/2, dt/2, dt, …
    for (int n = 0; particle.state.time < 1 - 1e-9; ++n) {
      ASSERT_TRUE(particle.step(tight(Integrator::bdf2), n % 3 == 0 ? dt : dt / 2, well).converged);
      largest =
          std::max(largest, std::abs(particle.state.positions[0].x() - std::cos(5 * particle.state.time)));
    }
    errors.push_back(largest);
  }
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 2, 0.2);
}

TEST(Bdf2, RestartsAfterAStepMoreThanTwiceAsLong) {
  Particle particle(Vec3(1, 0, 0));
  const test::Wells well(25);
  ASSERT_TRUE(particle.step(tight(Integrator::bdf2), 0.001, well).converged);
  ASSERT_TRUE(particle.step(tight(Integrator::bdf2), 0.001, well).converged);
  EXPECT_NEAR(step_context(Integrator::bdf2, particle.state, 0.002).dt, 0.002 * 3 / 5, 1e-15);
  EXPECT_EQ(step_context(Integrator::bdf2, particle.state, 0.0021).dt, 0.0021);
  EXPECT_NEAR(step_context(Integrator::bdf2, particle.state, 0.001).dt, 0.001 * 2 / 3, 1e-15);
}

TEST(Bdf2, DampsFarLessThanImplicitEuler) {
  const test::Wells well(25);
  double energy[2];
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2}) {
    Particle particle(Vec3(1, 0, 0));
    for (int n = 0; n < 500; ++n) ASSERT_TRUE(particle.step(tight(integrator), 0.01, well).converged);
    energy[integrator == Integrator::bdf2 ? 1 : 0] =
        25 * particle.state.positions[0].squaredNorm() + particle.state.velocities[0].squaredNorm();
  }
  EXPECT_LT(energy[0], 25 * 0.35);
  EXPECT_GT(energy[1], 25 * 0.94);
}

TEST(SymplecticEuler, KeepsTheEnergyOfAnOscillator) {
  const test::Wells well(25);
  Particle particle(Vec3(1, 0, 0));
  for (int n = 0; n < 10000; ++n) {
    ASSERT_TRUE(particle.step(tight(Integrator::symplectic_euler), 0.01, well).converged);
    const double energy =
        25 * particle.state.positions[0].squaredNorm() + particle.state.velocities[0].squaredNorm();
    ASSERT_NEAR(energy, 25, 25 * 0.055);
  }
}

/// Dashpots of a damping ratio: C = β K with ζ = βω/2.
class DampedWell : public Load {
 public:
  DampedWell(double k, double ratio) : c_(2 * ratio * std::sqrt(k)) {}
  std::unique_ptr<Potential> potential(const StepContext& step) const override {
    return std::make_unique<Dashpot>(c_ / step.dt, step.anchor[0]);
  }

 private:
  class Dashpot : public test::Wells {
   public:
    Dashpot(double c, const Vec3& anchor) : Wells(c), anchor_(anchor) {}
    double value(ConstVectors x) const override { return Wells::value(std::vector<Vec3>{x[0] - anchor_}); }
    void add_gradient(ConstVectors x, Vectors g) const override {
      Wells::add_gradient(std::vector<Vec3>{x[0] - anchor_}, g);
    }

   private:
    Vec3 anchor_;
  };
  double c_;
};

TEST(SymplecticEuler, IsStableUpToTheStepOfADampedOscillator) {
  const double omega = 20;
  const test::Wells well(omega * omega);
  for (const double ratio : {0.0, 0.1, 1.0, 30.0}) {
    const DampedWell damping(omega * omega, ratio);
    const double longest = 2 / omega * (std::sqrt(1 + ratio * ratio) - ratio);
    Particle stable(Vec3(1, 0, 0));
    for (int n = 0; n < 2000; ++n)
      ASSERT_TRUE(stable.step(tight(Integrator::symplectic_euler), 0.99 * longest, well, &damping).converged);
    EXPECT_LT(stable.state.positions[0].norm(), 20) << ratio;  // without damping 10 near the limit
    Particle unstable(Vec3(1, 0, 0));
    const StepReport report =
        unstable.step(tight(Integrator::symplectic_euler), 1.01 * longest, well, &damping);
    EXPECT_FALSE(report.converged) << ratio;
    EXPECT_NE(report.failure.find(fmt::format("step is about {:.3g} s", longest)), std::string::npos)
        << report.failure;
  }
}

TEST(SymplecticEuler, RefusesAStepThatIsNotStableAndNamesTheStableOne) {
  test::Flag flag;
  flag.hold_top_corners();
  SolverSettings settings;
  settings.integrator = Integrator::symplectic_euler;
  StepReport report;
  State before;
  for (int n = 0; n < 1000; ++n) {
    before = flag.state;
    report = flag.step(settings, 0.05);
    if (!report.converged) break;
  }
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.failure.find("stable"), std::string::npos) << report.failure;
  EXPECT_EQ(flag.state.positions, before.positions);
  for (const Vec3& p : flag.state.positions) EXPECT_LE(p.norm(), 1e3);

  test::Flag stable;
  stable.hold_top_corners();
  for (int n = 0; n < 2000; ++n) ASSERT_TRUE(stable.step(settings, 1.0 / 1000).converged);
}

}  // namespace
}  // namespace muslin
