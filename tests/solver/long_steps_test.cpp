// Steps of 1/24 s of the flag at 100 × 60 voxels, where an edge has k dt²/m = 694: hanging, and folded in
// many places after it was flung together.
#include <cmath>
#include <string>

#include "support/flag.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/solver/incremental_potential.hpp"
#include "muslin/solver/solver.hpp"

namespace muslin {
namespace {

constexpr double dt = 1.0 / 24;

test::Flag fine_flag() {
  test::Flag flag({100, 60, 1}, {20000, 100, 100}, 0.1);
  flag.hold_top_corners();
  return flag;
}

/// Every vertex flies towards the middle of the top edge faster than the sheet can give way in its plane.
void fling(test::Flag& flag) {
  const std::vector<Vec3> noise = test::random_vectors(flag.rest.size(), 0.002, 3);
  for (std::size_t v = 0; v < flag.rest.size(); ++v) {
    if (flag.fixed[v] != 0) continue;
    flag.state.velocities[v] = 10 * (Vec3(5, 6, 0.05) - flag.rest[v]);
    flag.state.positions[v].z() += noise[v].z();
  }
  SolverSettings loose;
  for (int n = 0; n < 40; ++n) ASSERT_TRUE(flag.step(loose, 1.0 / 240).converged) << "step " << n;
}

double compressed_edges(const test::Flag& flag) {
  int edges = 0, shorter = 0;
  const auto count = [&](const Vec3& a, const Vec3& b) {
    ++edges;
    if ((a - b).norm() < flag.lattice.width) ++shorter;
  };
  for (int j = 0; j < 60; ++j) {
    for (int i = 0; i < 100; ++i) {
      count(flag.at(i, j, 0), flag.at(i + 1, j, 0));
      count(flag.at(i, j, 0), flag.at(i, j + 1, 0));
    }
  }
  return static_cast<double>(shorter) / edges;
}

/// One step: in balance, by the report and by an evaluation of its own, and lower than where it started from.
void expect_a_step(test::Flag& flag, const std::string& where) {
  SolverSettings settings;
  settings.effort = Effort::exact;
  settings.tolerance = 1e-7;
  const StepProblem problem = flag.problem();
  const State before = flag.state;
  const StepContext context = step_context(settings.integrator, before, dt);
  const IncrementalPotential function(problem, context.inertial_prediction, dt);
  const StepReport report = solve_step(settings, context, problem, flag.state);
  ASSERT_TRUE(report.converged) << where << ": " << report.failure << ", residual " << report.residual;
  std::vector<Vec3> g(flag.rest.size());
  function.gradient(flag.state.positions, g);
  EXPECT_LE(function.imbalance(g).largest, 0.1) << where;
  std::vector<Vec3> prediction = context.inertial_prediction;
  for (std::size_t v = 0; v < prediction.size(); ++v)
    if (flag.fixed[v] != 0) prediction[v] = flag.targets[v];
  const double energy = function.value(flag.state.positions).value;
  EXPECT_LE(energy, function.value(prediction).value) << where;
  EXPECT_LE(energy, function.value(before.positions).value) << where;
  testing::Test::RecordProperty("newton_" + where, report.newton_iterations);
}

TEST(LongSteps, OfAHangingFineFlagConverge) {
  test::Flag flag = fine_flag();
  for (int n = 0; n < 12; ++n) expect_a_step(flag, "step_" + std::to_string(n));
}

TEST(LongSteps, OfACrumpledFineFlagConverge) {
  test::Flag flag = fine_flag();
  fling(flag);
  ASSERT_GT(compressed_edges(flag), 0.2) << "it is crumpled";
  for (int n = 0; n < 3; ++n) expect_a_step(flag, "step_" + std::to_string(n));
}

}  // namespace
}  // namespace muslin
