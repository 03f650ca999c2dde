// Bending by measured moments over curvature: strips on eight meshes bend by their curves, whatever the
// triangles; linear systems are at least as stiff as the sheet.
#include "muslin/energy/moment_curves.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/linearized_product.hpp"
#include "support/potential_battery.hpp"
#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/energy/shell_bending.hpp"
#include "muslin/geometry/triangulated_strip.hpp"
#include "muslin/solver/linearization.hpp"

namespace muslin {
namespace {

// Stiff threads that slide when they are bent further, and stiffen again.
const std::vector<Vec2> softens = {{5, 4e-4}, {10, 6e-4}, {20, 8e-4}, {30, 1.2e-3}};
const std::vector<Vec2> other = {{10, 1e-4}, {40, 3e-4}};

BendingCurves fabric() { return {StressCurve(softens), StressCurve(other), 6e-5, 0.25}; }

/// The plane z = 0 rolled up along x to this curvature.
std::vector<Vec3> rolled(const std::vector<Vec3>& flat, double curvature) {
  std::vector<Vec3> x;
  for (const Vec3& p : flat)
    x.emplace_back(std::sin(curvature * p.x()) / curvature, p.y(),
                   (1 - std::cos(curvature * p.x())) / curvature);
  return x;
}

class CurvedStrip : public testing::TestWithParam<std::string> {};

TEST_P(CurvedStrip, RolledUpHasTheMomentOfItsCurve) {
  // Triangles at the ends bear no moment at their free sides and store less: two rows of n.
  for (const bool along_warp : {true, false}) {
    const Vec3 warp = along_warp ? Vec3::UnitX() : Vec3::UnitY();
    const StressCurve curve = along_warp ? fabric().warp : fabric().weft;
    std::vector<std::vector<double>> moments;
    const std::vector<double> curvatures = {1, 4, 8, 16};  // edges turn by up to 0.4
    for (const int n : {40, 80}) {
      const Mesh mesh = triangulated_strip(GetParam(), n, 0.1, false);
      const ShellBending bending(build_shell(mesh, mesh.positions, {warp}), fabric());
      const auto energy = [&](double curvature) {
        return bending.value(rolled(mesh.positions, curvature)) / 0.1;
      };
      auto& row = moments.emplace_back();
      for (const double k : curvatures) row.push_back((energy(1.01 * k) - energy(0.99 * k)) / (0.02 * k));
    }
    for (std::size_t i = 0; i < curvatures.size(); ++i)
      EXPECT_NEAR((2 * moments[1][i] - moments[0][i]) / curve.stress(curvatures[i]), 1, 0.01)
          << curvatures[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, CurvedStrip,
                         testing::Values("right", "left", "alternating", "crossed", "equilateral", "jittered",
                                         "random", "delaunay"),
                         [](const auto& info) { return info.param; });

TEST(MomentCurves, OfConstantSlopesAreThePlate) {
  const Mesh mesh = test::flat_sheet(6, 5, 0.6, 0.5, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const ShellBending plate(shell, BendingModuli{3e-4, 1e-4, 2e-4, 0.3});
  const ShellBending curves(shell, BendingCurves{StressCurve(3e-4), StressCurve(1e-4), 2e-4, 0.3});
  const std::vector<Vec3> x = test::rolled(mesh.positions, 3, 0.4);
  EXPECT_NEAR(curves.value(x) / plate.value(x), 1, 1e-12);
}

TEST(MomentCurves, HasTheCurvaturesOfThePlate) {
  // One rigidity as a straight curve or as the plate's matrix.
  const Mesh mesh = test::flat_sheet(6, 5, 0.6, 0.5, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const BendingModuli warp_only{3e-4, 0, lowest_bias(3e-4, 0, 0), 0};
  std::vector<double> bent;
  for (std::size_t h = 0; h < shell.hinges.size(); ++h)
    bent.push_back(0.1 * std::sin(static_cast<double>(h)));
  const std::vector<double> moments = couple_hinges(shell, warp_only).times(bent);
  double twice = 0;
  for (std::size_t h = 0; h < bent.size(); ++h) twice += bent[h] * moments[h];
  const MomentCurves curves(plate_curvatures(shell, warp_only), shell.areas, StressCurve(3e-4),
                            StressCurve());
  EXPECT_NEAR(curves.energy(bent) / (0.5 * twice), 1, 1e-6);
}

TEST(MomentCurves, RolledBothWaysStoreAlike) {
  const Mesh mesh = test::flat_sheet(8, 6, 0.8, 0.6, 0.2);
  const ShellBending bending(build_shell(mesh, mesh.positions, {Vec3::UnitX()}), fabric());
  const double up = bending.value(test::rolled(mesh.positions, 6)),
               down = bending.value(test::rolled(mesh.positions, -6));
  EXPECT_NEAR(up / down, 1, 1e-9);
}

TEST(MomentCurves, LinearSystemsAreAtLeastAsStiff) {
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const ShellBending bending(shell, fabric(), block_pattern(shell));
  for (const double curvature : {0.5, 15.0}) {
    const std::vector<Vec3> x = test::sum(test::rolled(mesh.positions, curvature), 1,
                                          test::random_vectors(mesh.vertex_count(), 0.005, 3));
    const std::vector<double> masses(x.size(), 1e-9);
    const std::vector<std::uint8_t> fixed(x.size(), 0);
    Linearization h;
    h.reset(masses, fixed, 1);
    bending.linearize(x, h, 0);
    h.finish();
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      const std::vector<Vec3> p = test::random_vectors(x.size(), 1, seed);
      std::vector<Vec3> y(x.size(), Vec3::Zero());
      bending.add_stiffness_product(Stiffness::projected, x, p, y);
      EXPECT_GE(test::inner(p, test::product(h, p)), 0.99 * test::inner(p, y));
    }
  }
}

}  // namespace
}  // namespace muslin
