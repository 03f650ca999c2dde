// Internal friction of bending: the loop of moment over curvature on any mesh, what it loses, derivatives
// with a history, matrices.
#include "muslin/energy/bending_friction.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/clamped_strip.hpp"
#include "support/linearized_product.hpp"
#include "support/potential_battery.hpp"
#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/energy/element_energy.hpp"
#include "muslin/energy/shell_bending.hpp"

namespace muslin {
namespace {

constexpr double warp_limit = 3e-4, weft_limit = 1e-4;  // [N]
constexpr double reach = 0.5;                           // [1/m]
const BendingFrictionLimits limits{warp_limit, weft_limit, reach};

/// A load with its history.
struct Friction {
  explicit Friction(const Shell& shell, const BendingFrictionLimits& given = limits,
                    std::span<const std::uint8_t> held = {})
      : load("cloth", shell, std::make_shared<const HingeAngles>(shell, block_pattern(shell)), given, held) {}

  std::unique_ptr<Potential> from(const std::vector<Vec3>& x) const {
    StepContext step;
    step.positions = x;
    step.history = &history;
    return load.potential(step);
  }
  /// Makes a step to x; returns what it loses.
  double step(const std::vector<Vec3>& from_x, const std::vector<Vec3>& x) {
    const auto energy = from(from_x);
    load.end_step(*energy, x, history);
    return energy->dissipated(x);
  }

  BendingFriction load;
  History history;
};

/// Closed form: the moment of a spring in series with a slider.
class SpringAndSlider {
 public:
  double moment(double curvature) {
    slid_ = std::clamp(slid_, curvature - reach, curvature + reach);
    return warp_limit / reach * (curvature - slid_);
  }

 private:
  double slid_ = 0;
};

class FrictionLoop : public testing::TestWithParam<std::string> {};

/// Curvatures from 0 to `most`, to −`most` and to `most` again.
std::vector<double> loop(double most, int steps) {
  std::vector<double> path;
  const auto go = [&](int from, int to) {
    for (int i = from; i != to; i += from < to ? 1 : -1) path.push_back(most * i / steps);
  };
  go(0, steps);
  go(steps, -steps);
  go(-steps, steps + 1);
  return path;
}

TEST_P(FrictionLoop, OfAStripRolledToAndFroIsTheClosedForm) {
  constexpr double width = 0.25, most = 3, rigidity = 1e-4;
  constexpr int quarter = 12;
  const std::vector<double> path = loop(most, quarter);
  for (const int n : {10, 20, 40}) {
    const test::ClampedStrip strip(GetParam(), n, width);
    const Shell shell = build_shell(strip.mesh, strip.mesh.positions, {Vec3::UnitX()});
    const ShellBending plate(shell, BendingModuli{rigidity, rigidity, rigidity, 0}, nullptr, strip.held);
    Friction friction(shell, limits, strip.held);
    SpringAndSlider expected;
    double lost = 0, area = 0, worst = 0, before = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
      const std::vector<Vec3> x = strip.rolled(path[i - 1]);
      const auto energy = friction.from(x);
      const auto work = [&](double curvature) {
        const std::vector<Vec3> rolled = strip.rolled(curvature);
        return energy->value(rolled) + plate.value(rolled);
      };
      const double moment = (work(path[i] + 1e-3) - work(path[i] - 1e-3)) / (2e-3 * width);
      const double exact = rigidity * path[i] + expected.moment(path[i]);
      worst = std::max(worst, std::abs(moment - exact));
      const double loss = friction.step(x, strip.rolled(path[i]));
      EXPECT_GE(loss, 0);
      if (i > quarter) {
        lost += loss / width;
        area += (path[i] - path[i - 1]) * (moment + before) / 2;
      }
      before = moment;
    }
    const double exact = 4 * warp_limit * (most - reach);
    EXPECT_LE(worst, 0.01 * (warp_limit + rigidity * most)) << n;
    EXPECT_NEAR(area / exact, 1, 0.01) << n;
    EXPECT_NEAR(lost / exact, 1, 0.01) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, FrictionLoop,
                         testing::Values("right", "left", "alternating", "crossed", "equilateral", "jittered",
                                         "random", "delaunay"),
                         [](const auto& info) { return info.param; });

TEST(BendingFriction, OfEqualThreadsIsTheSameInEveryDirection) {
  // Triangles at the free sides bear less: two rows of n.
  const double curvature = 3;
  for (const double angle : {0.0, 0.4, 0.8, 1.2}) {
    std::vector<double> lost;
    for (const int n : {20, 40}) {
      const Mesh mesh = test::flat_sheet(n, n, 1, 1);
      Friction friction(build_shell(mesh, mesh.positions, {Vec3::UnitX()}), {warp_limit, warp_limit, 1e-3});
      lost.push_back(friction.step(mesh.positions, test::rolled(mesh.positions, curvature, angle)));
    }
    EXPECT_NEAR((2 * lost[1] - lost[0]) / (warp_limit * curvature), 1, 0.01) << angle;
  }
}

/// A sheet that has been bent once, and another shape in which some sliders stick and others slip.
struct BentSheet {
  BentSheet() {
    friction.step(mesh.positions, bent(8, 0.01, 3));
    energy = friction.from(bent(8, 0.01, 3));
  }
  std::vector<Vec3> bent(double curvature, double noise, std::uint32_t seed) const {
    return test::sum(test::rolled(mesh.positions, curvature), 1,
                     test::random_vectors(mesh.vertex_count(), noise, seed));
  }
  const ElementEnergy& element_energy() const { return dynamic_cast<const ElementEnergy&>(*energy); }

  Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  Friction friction{shell, {warp_limit, weft_limit, 3}};
  std::unique_ptr<Potential> energy;
  std::vector<Vec3> x = bent(5, 0.01, 4);
};

TEST(BendingFriction, DerivativesWithAHistoryAreThoseOfItsValue) {
  const BentSheet sheet;
  EXPECT_GT(sheet.energy->dissipated(sheet.x), 0);
  EXPECT_LT(sheet.energy->dissipated(sheet.x), 0.9 * sheet.energy->value(sheet.x));
  test::expect_gradient_matches_value(*sheet.energy, sheet.x, 0.1);
  test::expect_hessian_matches_gradient(*sheet.energy, sheet.x, 0.1);
  test::expect_hessian_symmetric(*sheet.energy, sheet.x);
  test::expect_rigid_motion_invariant(*sheet.energy, sheet.x);
}

TEST(BendingFriction, StiffnessIsNotNegativeAndMatricesHaveAtLeastHalfOfIt) {
  const BentSheet sheet;
  const std::vector<double> masses(sheet.x.size(), 1e-9);
  const std::vector<std::uint8_t> fixed(sheet.x.size(), 0);
  Linearization h;
  h.reset(masses, fixed, 1);
  sheet.energy->linearize(sheet.x, h, 0);
  h.finish();
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const std::vector<Vec3> p = test::random_vectors(sheet.x.size(), 1, seed);
    std::vector<Vec3> y(sheet.x.size(), Vec3::Zero());
    sheet.element_energy().add_stiffness_product(Stiffness::projected, sheet.x, p, y);
    EXPECT_GT(test::inner(p, y), 0);
    EXPECT_GE(test::inner(p, test::product(h, p)), 0.5 * test::inner(p, y));
  }
}

TEST(BendingFriction, SameBitsForAnyNumberOfThreads) {
  const Mesh mesh = test::flat_sheet(50, 50, 1, 1, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const std::vector<Vec3> x = test::rolled(mesh.positions, 6, 0.4),
                          back = test::rolled(mesh.positions, 4, 0.4);
  const auto result = [&](int threads) {
    set_thread_count(threads);
    Friction friction(shell);
    friction.step(mesh.positions, x);
    const auto energy = friction.from(x);
    std::vector<Vec3> g = test::gradient(*energy, back);
    g.emplace_back(energy->value(back), energy->dissipated(back), friction.step(x, back));
    return std::pair(g, friction.history.values);
  };
  const auto one = result(1);
  EXPECT_EQ(one, result(2));
  EXPECT_EQ(one, result(3));
  set_thread_count(0);
}

TEST(BendingFriction, AStepWithoutHistoryBeginsUnstressed) {
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  const std::vector<Vec3> x = test::rolled(mesh.positions, 5);
  const Friction friction(build_shell(mesh, mesh.positions, {Vec3::UnitX()}));
  const auto energy = friction.from(x);
  EXPECT_EQ(energy->value(x), 0);
  EXPECT_GT(energy->value(mesh.positions), 0);
}

TEST(BendingFriction, RefusesLimitsThatMakeNoSense) {
  const Mesh mesh = test::flat_sheet(2, 2, 1, 1);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  EXPECT_THROW(Friction(shell, {-1e-4, 1e-4, 1}), Error);
  EXPECT_THROW(Friction(shell, {1e-4, 1e-4, 0}), Error);
}

}  // namespace
}  // namespace muslin
