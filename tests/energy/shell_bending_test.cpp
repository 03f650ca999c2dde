// Bending of shells: derivatives, the rigidity of rolled sheets, folds, creases and inverted triangles at
// rest, clamps, and the matrix that bounds the coupling of hinges.
#include "muslin/energy/shell_bending.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/sheet.hpp"
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

constexpr double pi = std::numbers::pi;
constexpr BendingModuli even{1, 1, 1};
const Weave along_x{Vec3::UnitX()};

ShellBending bending(const Mesh& mesh, const BendingModuli& moduli) {
  return {build_shell(mesh, mesh.positions, along_x), moduli};
}

Eigen::MatrixXd dense(const HingeCoupling& coupling) {
  const auto n = static_cast<Eigen::Index>(coupling.lumped.size());
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index e = 0; e < n; ++e) {
    const auto row = static_cast<std::size_t>(e);
    for (int i = coupling.first[row]; i < coupling.first[row + 1]; ++i)
      k(e, coupling.columns[static_cast<std::size_t>(i)]) = coupling.values[static_cast<std::size_t>(i)];
  }
  return k;
}

/// K = Kᵀ ⪰ 0 and K ⪯ 2 Λ.
void expect_sound(const HingeCoupling& coupling) {
  const Eigen::MatrixXd k = dense(coupling);
  EXPECT_TRUE(k.allFinite());
  EXPECT_EQ(k, k.transpose());
  const Eigen::VectorXd lumped = Eigen::Map<const Eigen::VectorXd>(
      coupling.lumped.data(), static_cast<Eigen::Index>(coupling.lumped.size()));
  const auto least = [](const Eigen::MatrixXd& m) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues().minCoeff();
  };
  EXPECT_GE(least(k), -1e-9 * k.norm());
  EXPECT_GE(least(2 * Eigen::MatrixXd(lumped.asDiagonal()) - k), -1e-9 * k.norm());
}

/// D in units of the rigidity given: the energy of the sheet rolled up, over ½ κ² times its area.
double apparent_rigidity(const Mesh& mesh, const BendingModuli& moduli, double angle) {
  const double curvature = 2;
  const double energy = bending(mesh, moduli).value(test::rolled(mesh.positions, curvature, angle));
  return energy / (0.5 * curvature * curvature);
}

TEST(ShellBending, PassesTheBatteryBentAndFolded) {
  const Mesh mesh = test::flat_sheet(6, 5, 0.6, 0.5, 0.2);
  const ShellBending energy = bending(mesh, {1e-4, 3e-5, 6e-5, 0.3});
  const std::vector<Vec3> noise = test::random_vectors(mesh.vertex_count(), 0.02, 5);
  for (const double curvature : {0.5, 15.0}) {
    test::expect_elastic_energy_is_sound(energy, mesh.positions,
                                         test::sum(test::rolled(mesh.positions, curvature), 1, noise), 0.1);
  }
}

/// Three sheets of 4 by 3 squares that meet at 120° in the x axis, their polygons in this order of sheets.
Mesh three_sheets(const std::array<int, 3>& order) {
  Mesh mesh;
  for (int i = 0; i <= 4; ++i) mesh.positions.emplace_back(0.1 * i, 0, 0);
  for (int s = 0; s < 3; ++s) {
    const double angle = 2 * pi * s / 3;
    for (int k = 1; k <= 3; ++k)
      for (int i = 0; i <= 4; ++i)
        mesh.positions.emplace_back(0.1 * i, 0.1 * k * std::cos(angle), 0.1 * k * std::sin(angle));
  }
  for (const int s : order) {
    const auto vertex = [&](int i, int k) { return k == 0 ? i : 5 + 15 * s + 5 * (k - 1) + i; };
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 4; ++i) {
        std::array face = {vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1), vertex(i, k + 1)};
        // The middle sheet has its front on the other side.
        if (s == 1) std::reverse(face.begin(), face.end());
        mesh.add_face(face);
      }
  }
  return mesh;
}

TEST(ShellBending, ThreeSheetsAtAnEdgeBendAlikeWhicheverComesFirst) {
  const Mesh mesh = three_sheets({0, 1, 2});
  const BendingModuli moduli{1e-4, 1e-4, 1e-4};
  const ShellBending energy = bending(mesh, moduli);
  const std::vector<Vec3> x =
      test::sum(mesh.positions, 1, test::random_vectors(mesh.vertex_count(), 0.01, 5));
  EXPECT_NEAR(energy.value(mesh.positions), 0, 1e-20);
  test::expect_elastic_energy_is_sound(energy, mesh.positions, x, 0.1);
  const double stored = energy.value(x);
  for (const std::array<int, 3>& order : {std::array{1, 2, 0}, {2, 1, 0}, {1, 0, 2}})
    EXPECT_NEAR(bending(three_sheets(order), moduli).value(x), stored, 1e-9 * stored);
}

TEST(ShellBending, LargeSheetHasTheSameBitsForAnyThreadCount) {
  const Mesh mesh = test::flat_sheet(60, 50, 1, 1, 0.2);
  test::expect_same_bits_for_any_thread_count(
      bending(mesh, even), test::sum(mesh.positions, 1, test::random_vectors(mesh.vertex_count(), 0.005, 5)));
}

TEST(ShellBending, RestAngleNeedNotBeFlat) {
  Mesh mesh = test::flat_sheet(6, 5, 0.6, 0.5);
  mesh.positions = test::rolled(mesh.positions, 3);
  const ShellBending energy = bending(mesh, even);
  EXPECT_NEAR(energy.value(mesh.positions), 0, 1e-20);
  test::expect_elastic_energy_is_sound(
      energy, mesh.positions,
      test::sum(mesh.positions, 1, test::random_vectors(mesh.vertex_count(), 0.02, 5)), 0.1);
}

TEST(ShellBending, RolledSheetHasTheRigidityGivenInEveryDirection) {
  // Triangles at the border bear no moment at their free sides and store less: two rows of n.
  const BendingModuli threads{3, 0.5, 1.5, 0.25};
  for (const double jitter : {0.0, 0.2}) {
    const Mesh coarse = test::flat_sheet(20, 20, 1, 1, jitter), fine = test::flat_sheet(40, 40, 1, 1, jitter);
    const auto rigidity = [&](const BendingModuli& moduli, double angle) {
      return 2 * apparent_rigidity(fine, moduli, angle) - apparent_rigidity(coarse, moduli, angle);
    };
    for (const double angle : {0.0, pi / 4, -pi / 4, pi / 2, 0.3})
      EXPECT_NEAR(rigidity({1, 1, 1, 0.3}, angle), 1, 5e-3) << angle << " " << jitter;
    EXPECT_NEAR(rigidity(threads, 0) / 3, 1, 5e-3);
    EXPECT_NEAR(rigidity(threads, pi / 2) / 0.5, 1, 5e-3);
    EXPECT_NEAR(rigidity(threads, pi / 4) / 1.5, 1, 5e-3);
    EXPECT_NEAR(rigidity(threads, -pi / 4) / 1.5, 1, 5e-3);
  }
}

TEST(ShellBending, IsContinuousWhenFoldedFlat) {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 1, 0), Vec3(0.5, -1, 0)};
  mesh.add_face(std::array{0, 1, 2});
  mesh.add_face(std::array{1, 0, 3});
  const ShellBending energy = bending(mesh, even);
  const auto folded = [&](double angle) {
    std::vector<Vec3> x = mesh.positions;
    x[3] = Vec3(0.5, -std::cos(angle), -std::sin(angle));
    return x;
  };
  EXPECT_GT(energy.value(folded(3)), 0);
  EXPECT_NEAR(energy.value(folded(3)), energy.value(folded(-3)), 1e-12);
  EXPECT_NEAR(energy.value(folded(pi - 1e-9)), energy.value(folded(pi + 1e-9)), 1e-7);
  EXPECT_NEAR(hinge_angle(folded(1)[0], folded(1)[1], folded(1)[2], folded(1)[3]), 1, 1e-12);
  // Without area there is no direction, and no number that is not one.
  std::vector<Vec3> flat = mesh.positions;
  flat[3] = Vec3(0.25, 0, 0);
  for (const Vec3& g : test::gradient(energy, flat)) EXPECT_TRUE(g.allFinite());
  for (const Vec3& y : test::hessian_product(energy, flat, mesh.positions)) EXPECT_TRUE(y.allFinite());
}

TEST(ShellBending, FlippedPolygonsHaveTheSameBending) {
  const Mesh mesh = test::flat_sheet(5, 5, 1, 1, 0.2);
  Mesh mixed;
  mixed.positions = mesh.positions;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<int> face(mesh.face(f).begin(), mesh.face(f).end());
    if (f % 3 == 0) std::reverse(face.begin() + 1, face.end());
    mixed.add_face(face);
  }
  const std::vector<Vec3> x = test::rolled(mesh.positions, 1, 0.4);
  const double energy = bending(mesh, {1, 0.4, 0.6, 0.2}).value(x);
  EXPECT_NEAR(bending(mixed, {1, 0.4, 0.6, 0.2}).value(x), energy, 1e-12 * energy);
}

TEST(ShellBending, CouplingIsPositiveAndAtMostTwiceTheLumped) {
  const BendingModuli fabric{1, 0.2, 0.5, 0.3};
  for (const double jitter : {0.0, 0.2, 0.35}) {
    const Mesh mesh = test::flat_sheet(9, 7, 0.9, 0.7, jitter);
    expect_sound(couple_hinges(build_shell(mesh, mesh.positions, along_x), fabric));
  }
  const Mesh slivers = test::flat_sheet(9, 7, 9, 0.7, 0.1);
  expect_sound(couple_hinges(build_shell(slivers, slivers.positions, along_x), fabric));
  // No stiffness against one curvature, or against any.
  const Mesh mesh = test::flat_sheet(5, 5, 1, 1, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  for (const BendingModuli& limp : {BendingModuli{1, 0, 0.25}, BendingModuli{1, 1, 0.5}, BendingModuli{}})
    expect_sound(couple_hinges(shell, limp));
  EXPECT_EQ(ShellBending(shell, {}).value(test::rolled(mesh.positions, 3)), 0);
}

TEST(ShellBending, CreasesAndInvertedTrianglesAtRestAreHandled) {
  // A box folded along a line by 90 and by 180 degrees, and a vertex moved across its opposite edge.
  for (const double fold : {pi / 2, pi}) {
    Mesh mesh = test::flat_sheet(8, 5, 0.8, 0.5, 0.2);
    for (Vec3& p : mesh.positions) {
      const double over = p.x() - 0.4;
      if (over > 0.05) p = Vec3(0.4 + std::cos(fold) * over, std::sin(fold) * over, p.z());
    }
    const Shell shell = build_shell(mesh, mesh.positions, along_x);
    expect_sound(couple_hinges(shell, even));
    EXPECT_LT(ShellBending(shell, even).value(mesh.positions), 1e-20);
  }
  Mesh mesh = test::flat_sheet(6, 5, 0.6, 0.5);
  mesh.positions[16] += Vec3(0.13, 0, 0.02);
  const ShellBending energy(build_shell(mesh, mesh.positions, along_x), even);
  expect_sound(energy.coupling());
  EXPECT_LT(energy.value(mesh.positions), 1e-20);
  for (const Vec3& g : test::gradient(energy, test::rolled(mesh.positions, 1))) EXPECT_TRUE(g.allFinite());
}

TEST(ShellBending, HeldTrianglesStoreNoEnergy) {
  const Mesh mesh = test::flat_sheet(4, 3, 0.4, 0.3);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  const std::vector<std::uint8_t> held(mesh.vertex_count(), 1);
  EXPECT_EQ(ShellBending(shell, even, nullptr, held).value(test::rolled(mesh.positions, 3)), 0);
}

TEST(ShellBending, RefusesInvalidModuli) {
  const Mesh mesh = test::flat_sheet(2, 2, 1, 1);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  for (const BendingModuli& wrong :
       {BendingModuli{-1, 1, 1}, BendingModuli{1, 1, 1, 1}, BendingModuli{1, 1, 0.4}})
    EXPECT_THROW(couple_hinges(shell, wrong), Error);
}

TEST(ShellBending, LowestBiasDoesNotResistTwist) {
  const Mesh mesh = test::flat_sheet(12, 12, 1, 1);
  std::vector<Vec3> twisted = mesh.positions;
  for (Vec3& p : twisted) p.y() = 0.01 * p.x() * p.z();
  const double lowest = lowest_bias(4, 1, 0.25);
  EXPECT_DOUBLE_EQ(lowest, 1.5);
  const double stiff = bending(mesh, {4, 1, lowest + 1, 0.25}).value(twisted);
  EXPECT_LT(bending(mesh, {4, 1, lowest, 0.25}).value(twisted), 1e-4 * stiff);
}

}  // namespace
}  // namespace muslin
