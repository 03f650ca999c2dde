// Bending of shells: derivatives, the rigidity of rolled sheets, and hinges folded all the way.
#include "muslin/energy/hinge_bending.hpp"

#include <cmath>
#include <numbers>

#include "support/sheet.hpp"
#include <gtest/gtest.h>

namespace muslin {
namespace {

constexpr double pi = std::numbers::pi;
constexpr BendingModuli even{1, 1, 1};
const Weave along_x{Vec3::UnitX()};

HingeBending bending(const Mesh& mesh, const BendingModuli& moduli) {
  return {build_shell(mesh, mesh.positions, along_x), moduli};
}

/// D in units of the rigidity given: the energy of the sheet rolled up, over ½ κ² times its area.
double apparent_rigidity(const Mesh& mesh, const BendingModuli& moduli, double angle) {
  const double curvature = 2;
  const double energy = bending(mesh, moduli).value(test::rolled(mesh.positions, curvature, angle));
  return energy / (0.5 * curvature * curvature);
}

TEST(HingeBending, PassesTheBatteryBentAndFolded) {
  const Mesh mesh = test::flat_sheet(6, 5, 0.6, 0.5, 0.2);
  const HingeBending energy = bending(mesh, {1e-4, 3e-5, 5e-5});
  const std::vector<Vec3> noise = test::random_vectors(mesh.vertex_count(), 0.02, 5);
  for (const double curvature : {0.5, 15.0}) {
    test::expect_elastic_energy_is_sound(energy, mesh.positions,
                                         test::sum(test::rolled(mesh.positions, curvature), 1, noise), 0.1);
  }
}

TEST(HingeBending, LargeSheetHasTheSameBitsForAnyThreadCount) {
  const Mesh mesh = test::flat_sheet(60, 50, 1, 1);
  test::expect_same_bits_for_any_thread_count(
      bending(mesh, even), test::sum(mesh.positions, 1, test::random_vectors(mesh.vertex_count(), 0.005, 5)));
}

TEST(HingeBending, RestAngleNeedNotBeFlat) {
  Mesh mesh = test::flat_sheet(6, 5, 0.6, 0.5);
  mesh.positions = test::rolled(mesh.positions, 3);
  const HingeBending energy = bending(mesh, even);
  EXPECT_NEAR(energy.value(mesh.positions), 0, 1e-20);
  test::expect_elastic_energy_is_sound(
      energy, mesh.positions,
      test::sum(mesh.positions, 1, test::random_vectors(mesh.vertex_count(), 0.02, 5)), 0.1);
}

TEST(HingeBending, RolledSheetHasTheRigidityGiven) {
  // Outer edges have no hinge: of n rows of triangles (n − 1)/n bend.
  const int n = 40;
  const Mesh mesh = test::flat_sheet(n, n, 1, 1);
  const double edge_loss = (n - 1.0) / n;
  EXPECT_NEAR(apparent_rigidity(mesh, even, 0) / edge_loss, 1, 1e-3);
  EXPECT_NEAR(apparent_rigidity(mesh, even, pi / 2) / edge_loss, 1, 1e-3);
  // Warp bends across hinges along weft, and the other way round.
  EXPECT_NEAR(apparent_rigidity(mesh, {3, 0.5, 2}, 0) / edge_loss, 3, 3e-3);
  EXPECT_NEAR(apparent_rigidity(mesh, {3, 0.5, 2}, pi / 2) / edge_loss, 0.5, 1e-3);
}

TEST(HingeBending, RollUpMomentIsThatOfTheElastica) {
  // W = ½ D w (α/L)² L at the total angle α, so that M = dW/dα = 2π D w / L when the ends meet.
  const int n = 64;
  const double length = 2, width = 0.25, rigidity = 3e-4;
  const Mesh mesh = test::flat_sheet(n, n / 8, length, width);
  const HingeBending energy = bending(mesh, {rigidity, rigidity, rigidity});
  const auto at = [&](double angle) { return energy.value(test::rolled(mesh.positions, angle / length)); };
  const double d = 1e-4;
  const double moment = (at(2 * pi + d) - at(2 * pi - d)) / (2 * d);
  EXPECT_NEAR(moment / (2 * pi * rigidity * width / length), 1, 0.02);
}

TEST(HingeBending, IrregularMeshIsAtMostAFifthStiffer) {
  const Mesh mesh = test::flat_sheet(40, 40, 1, 1, 0.2);
  for (const double angle : {0.0, pi / 2}) {
    const double ratio = apparent_rigidity(mesh, even, angle);
    EXPECT_GT(ratio, 0.95);
    EXPECT_LT(ratio, 1.2);
  }
}

TEST(HingeBending, FoldedFlatItStaysContinuous) {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 1, 0), Vec3(0.5, -1, 0)};
  mesh.add_face(std::array{0, 1, 2});
  mesh.add_face(std::array{1, 0, 3});
  const HingeBending energy = bending(mesh, even);
  const auto folded = [&](double angle) {
    std::vector<Vec3> x = mesh.positions;
    x[3] = Vec3(0.5, -std::cos(angle), -std::sin(angle));
    return x;
  };
  EXPECT_NEAR(energy.value(folded(3)), energy.value(folded(-3)), 1e-12);
  EXPECT_NEAR(energy.value(folded(pi - 1e-9)), energy.value(folded(pi + 1e-9)), 1e-7);
  EXPECT_NEAR(hinge_angle(folded(1)[0], folded(1)[1], folded(1)[2], folded(1)[3]), 1, 1e-12);
  // Without area there is no direction, and no number that is not one.
  std::vector<Vec3> flat = mesh.positions;
  flat[3] = Vec3(0.25, 0, 0);
  for (const Vec3& g : test::gradient(energy, flat)) EXPECT_TRUE(g.allFinite());
  for (const Vec3& y : test::hessian_product(energy, flat, mesh.positions)) EXPECT_TRUE(y.allFinite());
}

TEST(HingeBending, FlippedPolygonsBendAlike) {
  const Mesh mesh = test::flat_sheet(5, 5, 1, 1);
  Mesh mixed;
  mixed.positions = mesh.positions;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<int> face(mesh.face(f).begin(), mesh.face(f).end());
    if (f % 3 == 0) std::reverse(face.begin() + 1, face.end());
    mixed.add_face(face);
  }
  const std::vector<Vec3> x = test::rolled(mesh.positions, 1);
  EXPECT_NEAR(bending(mixed, even).value(x), bending(mesh, even).value(x), 1e-12);
}

TEST(HingeBending, LowestBiasLeavesNoDirectionNegative) {
  EXPECT_DOUBLE_EQ(lowest_bias(4, 4), 0);
  const double bias = lowest_bias(9, 1);
  EXPECT_DOUBLE_EQ(bias, 1);
  double least = 1e9;
  for (double share = 0; share <= 1; share += 0.001)
    least = std::min(least,
                     9 * share * share + (1 - share) * (1 - share) + (4 * bias - 10) * share * (1 - share));
  EXPECT_NEAR(least, 0, 1e-4);
}

}  // namespace
}  // namespace muslin
