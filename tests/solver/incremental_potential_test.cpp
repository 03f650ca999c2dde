// The incremental potential: value and gradient together and apart, the imbalance, what a Stepper keeps.
#include "muslin/solver/incremental_potential.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "support/lattice_box.hpp"
#include "support/potential_battery.hpp"
#include "support/simple_potentials.hpp"
#include <gtest/gtest.h>

#include "muslin/energy/spring_damping.hpp"

namespace muslin {
namespace {

class IncrementalPotentialTest : public testing::Test {
 protected:
  /// Several blocks of vertices, two of them held.
  const Lattice lattice_ = test::box_lattice({60, 40, 1});
  const std::vector<Vec3> rest_ = test::rest_positions(lattice_);
  const SpringEnergy springs_{build_springs(lattice_, Bracing::kuhn), 1, {20000, 100, 100}};
  std::vector<double> masses_ = std::vector<double>(rest_.size(), 2.0);
  const test::UniformGravity gravity_{masses_, Vec3(0, -9.8, 0)};
  std::vector<std::uint8_t> fixed_ = std::vector<std::uint8_t>(rest_.size(), 0);
  static constexpr double dt_ = 0.01;

  void SetUp() override {
    fixed_[0] = fixed_[4321] = 1;
    masses_[100] = 0.5;
  }
  StepProblem problem() const { return {masses_, {&springs_, &gravity_}, fixed_, rest_}; }
};

TEST_F(IncrementalPotentialTest, ValueAndGradientTogetherAreTheBitsOfBothApart) {
  const StepProblem step = problem();
  const IncrementalPotential function(step, rest_, dt_);
  const std::vector<Vec3> x = test::sum(rest_, 0.2, test::random_vectors(rest_.size(), 1, 3));
  std::vector<Vec3> together(x.size(), Vec3(1, 2, 3)), apart = together;
  const IncrementalPotential::Value value = function.value_and_gradient(x, together);
  function.gradient(x, apart);
  EXPECT_EQ(value.value, function.value(x).value);
  EXPECT_EQ(value.magnitude, function.value(x).magnitude);
  EXPECT_EQ(together, apart);
  EXPECT_EQ(together[0], Vec3::Zero());
  EXPECT_EQ(together[4321], Vec3::Zero());

  // Against the definition, where nothing else pulls.
  const StepProblem free_flight{masses_, {}, fixed_, rest_};
  const IncrementalPotential inertia(free_flight, rest_, dt_);
  double expected = 0;
  for (std::size_t v = 0; v < x.size(); ++v) expected += 0.5 * masses_[v] * (x[v] - rest_[v]).squaredNorm();
  EXPECT_NEAR(inertia.value_and_gradient(x, together).value, expected, 1e-12 * expected);
  for (std::size_t v = 1; v < 4321; ++v)
    ASSERT_LE((together[v] - masses_[v] * (x[v] - rest_[v])).norm(), 1e-14);
}

TEST_F(IncrementalPotentialTest, ImbalanceIsTheLargestAccelerationOfAFreeVertex) {
  const StepProblem step = problem();
  const IncrementalPotential function(step, rest_, dt_);
  std::vector<Vec3> g = test::random_vectors(rest_.size(), 0.1, 4);
  g[100] = Vec3(0, 3, 4);      // 0.5 kg: 10 m per dt²
  g[4900] = Vec3(0, 0, 8);     // 2 kg: 4 m per dt²
  g[4321] = Vec3(1000, 0, 0);  // held
  const IncrementalPotential::Imbalance imbalance = function.imbalance(g);
  EXPECT_EQ(imbalance.vertex, 100);
  EXPECT_NEAR(imbalance.largest, 10 / (dt_ * dt_), 1e-6);
  double square = 0;
  for (std::size_t v = 0; v < g.size(); ++v) square += fixed_[v] != 0 ? 0 : g[v].squaredNorm();
  EXPECT_NEAR(imbalance.norm, std::sqrt(square), 1e-12 * std::sqrt(square));
}

TEST_F(IncrementalPotentialTest, ImbalanceNamesTheFirstNonFiniteVertex) {
  const StepProblem step = problem();
  const IncrementalPotential function(step, rest_, dt_);
  std::vector<Vec3> g = test::random_vectors(rest_.size(), 0.1, 4);
  g[50] = Vec3(0, 1e9, 0);
  g[200].y() = g[4800].y() = std::numeric_limits<double>::quiet_NaN();
  g[201] = Vec3(1e12, 0, 0);
  const IncrementalPotential::Imbalance imbalance = function.imbalance(g);
  EXPECT_EQ(imbalance.vertex, 200);
  EXPECT_TRUE(std::isnan(imbalance.largest));
  EXPECT_FALSE(std::isfinite(imbalance.norm));
}

TEST_F(IncrementalPotentialTest, AStepperKeepsAtMost300BytesAVertex) {
  State state;
  state.positions = rest_;
  state.velocities.assign(rest_.size(), Vec3::Zero());
  Stepper stepper;
  const StepContext context = step_context(Integrator::implicit_euler, state, dt_);
  ASSERT_TRUE(stepper.step({}, context, problem(), state).converged);
  EXPECT_LE(static_cast<double>(stepper.bytes()) / static_cast<double>(rest_.size()), 300);
}

}  // namespace
}  // namespace muslin
