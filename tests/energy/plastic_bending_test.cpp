// Bending that takes a set: moment over curvature and what stays on any mesh, what is lost, derivatives with
// a history, matrices.
#include "muslin/energy/plastic_bending.hpp"

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

namespace muslin {
namespace {

constexpr double rigidity = 1e-4;        // [N·m]
constexpr double yield_curvature = 0.5;  // [1/m]
const BendingModuli paper{rigidity, rigidity, rigidity, 0.2};

/// A load with its history.
struct Plastic {
  Plastic(const Shell& shell, const BendingModuli& moduli, const BendingYield& yield,
          std::span<const std::uint8_t> held = {})
      : elastic(std::make_shared<ShellBending>(shell, moduli, block_pattern(shell), held)),
        load("cloth", shell, moduli, yield, elastic, held) {}

  std::unique_ptr<Potential> begin(double length = 0) const {
    StepContext step;
    step.history = &history;
    step.length = length;
    return load.potential(step);
  }
  /// Makes a step to x; returns what it loses.
  double step(const std::vector<Vec3>& x, double length = 0) {
    const auto energy = begin(length);
    load.end_step(*energy, x, history);
    return energy->dissipated(x);
  }

  std::shared_ptr<const ShellBending> elastic;
  PlasticBending load;
  History history;
};

/// Closed form: the moment per width of a sheet that hardens kinematically.
class HardeningPlate {
 public:
  explicit HardeningPlate(double hardening) : hardening_(hardening) {}
  double moment(double curvature) {
    set_ = std::clamp(set_, curvature - yield_curvature, curvature + yield_curvature);
    return rigidity * (hardening_ * curvature + (1 - hardening_) * (curvature - set_));
  }

 private:
  double hardening_, set_ = 0;
};

/// The curvature in 0 … `most` at which `energy` is least, of a strip rolled up.
double released(const Potential& energy, const test::ClampedStrip& strip, double most) {
  double low = 0, high = most;
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (energy.value(strip.rolled(a)) < energy.value(strip.rolled(b))) {
      high = b;
    } else {
      low = a;
    }
  }
  return (low + high) / 2;
}

class PlasticStrip : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Meshes, PlasticStrip,
                         testing::Values("right", "left", "alternating", "crossed", "equilateral", "jittered",
                                         "random", "delaunay"),
                         [](const auto& info) { return info.param; });

TEST_P(PlasticStrip, BentRoundACylinderKeepsWhatIsBeyondYield) {
  constexpr double width = 0.25, most = 3;
  for (const double hardening : {0.0, 0.2}) {
    const test::ClampedStrip strip(GetParam(), 20, width);
    const Shell shell = build_shell(strip.mesh, strip.mesh.positions, {Vec3::UnitX()});
    Plastic plastic(shell, {rigidity, rigidity, rigidity, 0}, {yield_curvature, hardening}, strip.held);
    plastic.step(strip.rolled(most));
    EXPECT_NEAR(released(*plastic.begin(), strip, most), (1 - hardening) * (most - yield_curvature),
                0.01 * most);
  }
}

TEST_P(PlasticStrip, RolledToAndFroLosesTheAreaOfTheLoopOfMomentOverCurvature) {
  constexpr double width = 0.25, most = 3, hardening = 0.2;
  constexpr int quarter = 12;
  std::vector<double> path;
  for (int i = 0; i <= quarter; ++i) path.push_back(most * i / quarter);
  for (int i = quarter - 1; i >= -quarter; --i) path.push_back(most * i / quarter);
  for (int i = 1 - quarter; i <= quarter; ++i) path.push_back(most * i / quarter);
  for (const int n : {10, 20, 40}) {
    const test::ClampedStrip strip(GetParam(), n, width);
    const Shell shell = build_shell(strip.mesh, strip.mesh.positions, {Vec3::UnitX()});
    Plastic plastic(shell, {rigidity, rigidity, rigidity, 0}, {yield_curvature, hardening}, strip.held);
    HardeningPlate expected(hardening);
    double lost = 0, area = 0, worst = 0, before = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
      const auto energy = plastic.begin();
      const double moment =
          (energy->value(strip.rolled(path[i] + 1e-3)) - energy->value(strip.rolled(path[i] - 1e-3))) /
          (2e-3 * width);
      worst = std::max(worst, std::abs(moment - expected.moment(path[i])));
      const double loss = plastic.step(strip.rolled(path[i]));
      EXPECT_GE(loss, 0);
      if (i > quarter) {
        lost += loss / width;
        area += (path[i] - path[i - 1]) * (moment + before) / 2;
      }
      before = moment;
    }
    const double exact = 4 * (1 - hardening) * rigidity * yield_curvature * (most - yield_curvature);
    EXPECT_LE(worst, 0.015 * rigidity * (yield_curvature + hardening * most)) << n;
    EXPECT_NEAR(area / exact, 1, 0.01) << n;
    EXPECT_NEAR(lost / exact, 1, 0.01) << n;
  }
}

TEST(PlasticBending, OfAnIsotropicSheetIsTheSameInEveryDirection) {
  // Triangles at the free sides bear less: two rows of n.
  const double curvature = 3;
  for (const double angle : {0.0, 0.4, 0.8, 1.2}) {
    std::vector<double> lost;
    for (const int n : {20, 40}) {
      const Mesh mesh = test::flat_sheet(n, n, 1, 1);
      Plastic plastic(build_shell(mesh, mesh.positions, {Vec3::UnitX()}), {rigidity, rigidity, rigidity, 0},
                      {yield_curvature, 0});
      lost.push_back(plastic.step(test::rolled(mesh.positions, curvature, angle)));
    }
    EXPECT_NEAR((2 * lost[1] - lost[0]) / (rigidity * yield_curvature * (curvature - yield_curvature)), 1,
                0.01)
        << angle;
  }
}

TEST(PlasticBending, BelowYieldIsThePlate) {
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const BendingModuli cloth{3e-4, 1e-4, 2e-4, 0.2};
  const Plastic plastic(shell, cloth, {1e3, 0.3});
  const std::vector<Vec3> x =
      test::sum(test::rolled(mesh.positions, 5, 0.3), 1, test::random_vectors(mesh.vertex_count(), 0.01, 3));
  const auto energy = plastic.begin();
  EXPECT_EQ(energy->dissipated(x), 0);
  EXPECT_NEAR(energy->value(x) / plastic.elastic->value(x), 1, 1e-10);
}

TEST(PlasticBending, SetsFadeInTheTimeOfRecovery) {
  constexpr double fading = 2;  // [s]
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  Plastic plastic(shell, paper, {yield_curvature, 0, fading});
  const std::vector<Vec3> bent = test::rolled(mesh.positions, 0.9 * yield_curvature);
  plastic.step(test::rolled(mesh.positions, 1.5 * yield_curvature));
  const std::vector<double> creased = plastic.history.values;
  for (int i = 0; i < 10; ++i) plastic.step(bent, 0.1);
  for (std::size_t i = 0; i < creased.size(); ++i)
    EXPECT_NEAR(plastic.history.values[i], creased[i] * std::exp(-1 / fading), 1e-12 * yield_curvature);
}

/// A sheet that has been bent once, and another shape in which some triangles yield.
struct CreasedSheet {
  CreasedSheet() {
    plastic.step(bent(8, 0.01, 3));
    energy = plastic.begin();
  }
  std::vector<Vec3> bent(double curvature, double noise, std::uint32_t seed) const {
    return test::sum(test::rolled(mesh.positions, curvature), 1,
                     test::random_vectors(mesh.vertex_count(), noise, seed));
  }
  const ElementEnergy& element_energy() const { return dynamic_cast<const ElementEnergy&>(*energy); }

  Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  Plastic plastic{shell, paper, {3, 0.1}};
  std::unique_ptr<Potential> energy;
  std::vector<Vec3> x = bent(5, 0.01, 4);
};

TEST(PlasticBending, DerivativesWithAHistoryAreThoseOfItsValue) {
  const CreasedSheet sheet;
  EXPECT_GT(sheet.energy->dissipated(sheet.x), 0);
  EXPECT_LT(sheet.energy->dissipated(sheet.x), 0.9 * sheet.energy->value(sheet.x));
  test::expect_gradient_matches_value(*sheet.energy, sheet.x, 0.1);
  test::expect_hessian_matches_gradient(*sheet.energy, sheet.x, 0.1);
  test::expect_hessian_symmetric(*sheet.energy, sheet.x);
  test::expect_rigid_motion_invariant(*sheet.energy, sheet.x);
}

TEST(PlasticBending, MatricesOfHeavySheetsHaveHalfOfTheStiffnessAndThoseOfStiffOnesAllOfIt) {
  const CreasedSheet sheet;
  const std::vector<std::uint8_t> fixed(sheet.x.size(), 0);
  for (const double mass : {1.0, 1e-9}) {
    const std::vector<double> masses(sheet.x.size(), mass);
    Linearization h;
    h.reset(masses, fixed, 1);
    sheet.energy->linearize(sheet.x, h, 0);
    h.finish();
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      const std::vector<Vec3> p = test::random_vectors(sheet.x.size(), 1, seed);
      std::vector<Vec3> y(sheet.x.size(), Vec3::Zero());
      sheet.element_energy().add_stiffness_product(Stiffness::projected, sheet.x, p, y);
      const double stiffness = test::inner(p, y), inertia = mass * test::inner(p, p),
                   matrix = test::inner(p, test::product(h, p)) - inertia;
      EXPECT_GT(stiffness, 0);
      if (mass == 1) {
        EXPECT_GE(matrix, 0.5 * stiffness - 1e-6 * inertia);
      } else {
        EXPECT_NEAR(matrix / stiffness, 1, 1e-4);
      }
    }
  }
}

TEST(PlasticBending, SameBitsForAnyNumberOfThreads) {
  const Mesh mesh = test::flat_sheet(50, 50, 1, 1, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const std::vector<Vec3> x = test::rolled(mesh.positions, 6, 0.4),
                          back = test::rolled(mesh.positions, 4, 0.4);
  const auto result = [&](int threads) {
    set_thread_count(threads);
    Plastic plastic(shell, paper, {yield_curvature, 0.1});
    plastic.step(x);
    const auto energy = plastic.begin();
    std::vector<Vec3> g = test::gradient(*energy, back);
    g.emplace_back(energy->value(back), energy->dissipated(back), plastic.step(back));
    return std::pair(g, plastic.history.values);
  };
  const auto one = result(1);
  EXPECT_EQ(one, result(2));
  EXPECT_EQ(one, result(3));
  set_thread_count(0);
}

TEST(PlasticBending, RefusesNumbersThatMakeNoSense) {
  const Mesh mesh = test::flat_sheet(2, 2, 1, 1);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  EXPECT_THROW(Plastic(shell, paper, {0, 0}), Error);
  EXPECT_THROW(Plastic(shell, paper, {1, 1.5}), Error);
  EXPECT_THROW(Plastic(shell, paper, {1, 0, 0}), Error);
  EXPECT_THROW(Plastic(shell, {}, {1, 0}), Error);
}

}  // namespace
}  // namespace muslin
