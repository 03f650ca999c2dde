// A membrane of measured curves: strips on eight meshes pull as the curves say, along both threads, both
// ways at once and at 45 degrees; shear; limits.
#include "muslin/energy/measured_membrane.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "support/potential_battery.hpp"
#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/geometry/triangulated_strip.hpp"
#include "muslin/material/measured_sheet.hpp"

namespace muslin {
namespace {

constexpr double width = 0.25, poisson = 0.3;

ShellMaterial knit() {
  ShellMaterial material;
  material.warp_curve = {{0.02, 1}, {0.05, 4}, {0.1, 15}, {0.15, 45}, {0.2, 110}};
  material.weft_curve = {{0.05, 2}, {0.2, 14}, {0.4, 60}};
  material.shear_curve = {{1, 0.4}, {4, 2}, {8, 5}, {20, 30}};
  return material;
}

/// Forces of a strip that is deformed evenly, to (x, y) of its lengths.
struct Pulled {
  Vec3 end = Vec3::Zero(), side = Vec3::Zero();  ///< per length of the edges x = 1 and y = width [N/m]
  double inside = 0;                             ///< the largest on a vertex off the edges [N]
};

Pulled pull(const std::string& kind, const Vec3& warp, const SheetStress& stress, double x, double y) {
  const Mesh mesh = triangulated_strip(kind, 8, width, false);
  const MeasuredMembrane energy(build_shell(mesh, mesh.positions, {warp}), stress, poisson);
  std::vector<Vec3> at = mesh.positions;
  for (Vec3& p : at) p = Vec3(x * p.x(), y * p.y(), 0);
  const std::vector<Vec3> force = test::gradient(energy, at);
  Pulled result;
  for (std::size_t v = 0; v < at.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    const bool end = p.x() > 1 - 1e-9, side = p.y() > width - 1e-9;
    if (end) result.end += force[v] / width;
    if (side) result.side += force[v];
    if (!end && !side && p.x() > 1e-9 && p.y() > 1e-9)
      result.inside = std::max(result.inside, force[v].norm());
  }
  return result;
}

class MeasuredStrip : public testing::TestWithParam<std::string> {};

TEST_P(MeasuredStrip, PullsAsItsCurvesAndNarrows) {
  const ShellMaterial material = knit();
  const SheetStress stress = stress_of(material);
  const double warp = stress.warp.slope(0), weft = stress.weft.slope(0);
  for (const bool along_warp : {true, false}) {
    const double ratio = poisson * std::sqrt(along_warp ? warp / weft : weft / warp);
    for (const Vec2& point : along_warp ? *material.warp_curve : *material.weft_curve) {
      const double strain = point[0] * (1 + 0.5 * point[0]), narrow = std::sqrt(1 - 2 * ratio * strain);
      const Pulled strip =
          pull(GetParam(), along_warp ? Vec3::UnitX() : Vec3::UnitY(), stress, 1 + point[0], narrow);
      EXPECT_NEAR(strip.end.x() / point[1], 1, 1e-9);
      EXPECT_NEAR(strip.side.y(), 0, 1e-9 * point[1]);
      EXPECT_NEAR(strip.inside, 0, 1e-9 * point[1]);
    }
  }
}

TEST_P(MeasuredStrip, PulledBothWaysAddsTheCoupling) {
  const SheetStress stress = stress_of(knit());
  const double warp = stress.warp.slope(0), weft = stress.weft.slope(0), square = poisson * poisson;
  const double coupling = poisson * std::sqrt(warp * weft) / (1 - square);
  const Pulled strip = pull(GetParam(), Vec3::UnitX(), stress, 1.12, 1.07);
  const double u = 0.5 * (1.12 * 1.12 - 1), v = 0.5 * (1.07 * 1.07 - 1), more = square / (1 - square);
  EXPECT_NEAR(strip.end.x() / (1.12 * (stress.warp.stress(u) + more * warp * u + coupling * v)), 1, 1e-9);
  EXPECT_NEAR(strip.side.y() / (1.07 * (stress.weft.stress(v) + more * weft * v + coupling * u)), 1, 1e-9);
}

TEST_P(MeasuredStrip, OnTheBiasPullsByShear) {
  // Equal threads at 45°: E_uu = E_vv = (x² + y² − 2)/4 and γ = (x² − y²)/2, so that no force on the sides
  // means that stretch and shear have one stress, and the end bears x times twice that.
  ShellMaterial material = knit();
  material.weft_curve = material.warp_curve;
  const SheetStress stress = stress_of(material);
  const double slope = stress.warp.slope(0), more = poisson / (1 - poisson) * slope;
  const double x = 1.15;
  double low = 0.5, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double y = 0.5 * (low + high), strain = (x * x + y * y - 2) / 4, shear = (x * x - y * y) / 2;
    (stress.warp.stress(strain) + more * strain < stress.shear.stress(shear) ? low : high) = y;
  }
  const Pulled strip = pull(GetParam(), Vec3(1, 1, 0), stress, x, low);
  EXPECT_NEAR(strip.end.x() / (2 * x * stress.shear.stress((x * x - low * low) / 2)), 1, 1e-9);
  EXPECT_NEAR(strip.side.y(), 0, 1e-9);
  EXPECT_NEAR(strip.inside, 0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Meshes, MeasuredStrip,
                         testing::Values("right", "left", "alternating", "crossed", "equilateral", "jittered",
                                         "random", "delaunay"),
                         [](const auto& info) { return info.param; });

TEST(MeasuredMembrane, OfConstantSlopesIsStVenantKirchhoff) {
  const Mesh mesh = test::flat_sheet(5, 4, 0.5, 0.4, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const MeasuredMembrane measured(shell, {StressCurve(900), StressCurve(500), StressCurve(130)}, 0.25);
  const MembraneEnergy membrane(shell, {900, 500, 130, 0.25});
  const std::vector<Vec3> x =
      test::sum(mesh.positions, 1, test::random_vectors(mesh.vertex_count(), 0.03, 5));
  EXPECT_NEAR(measured.value(x) / membrane.value(x), 1, 1e-12);
  const std::vector<Vec3> force = test::gradient(membrane, x);
  EXPECT_LT(test::norm(test::sum(test::gradient(measured, x), -1, force)), 1e-12 * test::norm(force));
}

TEST(MeasuredMembrane, ShearDoesTheWorkOfTheTest) {
  const Mesh mesh = test::flat_sheet(3, 2, 0.6, 0.4);
  const ShellMaterial material = knit();
  const MeasuredMembrane energy(build_shell(mesh, mesh.positions, {Vec3::UnitX()}), stress_of(material),
                                poisson);
  const auto density = [&](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    std::vector<Vec3> x = mesh.positions;
    for (Vec3& p : x) p = Vec3(p.x() + std::sin(angle) * p.z(), 0, std::cos(angle) * p.z());
    return energy.value(x) / 0.24;
  };
  for (const double sign : {-1.0, 1.0}) {
    for (const Vec2& point : *material.shear_curve) {
      const double d = 1e-4, per_radian = 180 / std::numbers::pi / (2 * d);
      const double force = (density(sign * point[0] + d) - density(sign * point[0] - d)) * per_radian;
      EXPECT_NEAR(force / (sign * point[1]), 1, 1e-6);
    }
  }
}

TEST(MeasuredMembrane, IsConvexUpToTheHighestPoissonRatioAndRefusedBeyond) {
  ShellMaterial material = knit();
  material.warp_curve = material.weft_curve = {{0.05, 40}, {0.2, 50}, {0.3, 90}};
  const SheetStress stress = stress_of(material);
  const double highest = highest_poisson(stress);
  ASSERT_LT(highest, 0.5);
  const Mesh mesh = test::flat_sheet(2, 2, 0.2, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const auto softest = [&](const MeasuredMembrane& energy) {
    double least = std::numeric_limits<double>::infinity();
    for (double x = 0.9; x < 1.5; x += 0.01) {
      for (double z = 0.9; z < 1.5; z += 0.01) {
        std::vector<Vec3> at = mesh.positions;
        for (Vec3& each : at) each = Vec3(x * each.x(), 0, z * each.z());
        // One thread alone stretches, or one as the other one shortens: the worst direction of equal threads.
        for (const Vec3& share : {Vec3(1, 0, -1), Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
          std::vector<Vec3> p = mesh.positions, y(at.size(), Vec3::Zero());
          for (Vec3& each : p) each = Vec3(share.x() * each.x() / x, 0, share.z() * each.z() / z);
          energy.add_stiffness_product(Stiffness::material, at, p, y);
          least = std::min(least, test::inner(p, y));
        }
      }
    }
    return least;
  };
  EXPECT_GE(softest(MeasuredMembrane(shell, stress, highest)), -1e-12);
  // Weft that bends much more stiffly than warp could make a stretched warp buckle.
  for (const BucklingRigidity& rigidity : {BucklingRigidity{1e-3, 1}, BucklingRigidity{1, 1e-3}})
    EXPECT_GE(softest(MeasuredMembrane(shell, stress, highest, nullptr, rigidity)), -1e-12);
  EXPECT_THROW(MeasuredMembrane(shell, stress, 1.01 * highest), Error);
  EXPECT_THROW(MeasuredMembrane(shell, stress, -0.1), Error);
}

}  // namespace
}  // namespace muslin
