// Stretch and shear of shells: derivatives, closed forms of the moduli, threads that follow the weave.
#include "muslin/energy/membrane_energy.hpp"

#include <cmath>
#include <numbers>

#include "support/linearized_product.hpp"
#include "support/sheet.hpp"
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace muslin {
namespace {

constexpr MembraneModuli cloth{900, 500, 130, 0.25};
const Weave along_x{Vec3::UnitX()};

std::vector<Vec3> mapped(const std::vector<Vec3>& rest, const Mat3& f) {
  std::vector<Vec3> x = rest;
  for (Vec3& p : x) p = f * p;
  return x;
}

/// Energy per area of the sheet stretched to (warp, weft) and sheared by an angle in its plane.
double density(const MembraneModuli& moduli, double warp, double weft, double shear = 0) {
  const Mesh mesh = test::flat_sheet(3, 2, 0.6, 0.4);
  const MembraneEnergy energy(build_shell(mesh, mesh.positions, along_x), moduli);
  Mat3 f = Mat3::Identity();
  f.col(0) = warp * Vec3::UnitX();
  f.col(2) = weft * Vec3(std::sin(shear), 0, std::cos(shear));
  return energy.value(mapped(mesh.positions, f)) / 0.24;
}

TEST(MembraneEnergy, PassesTheBatteryStretchedAndCrumpled) {
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  const MembraneEnergy energy(build_shell(mesh, mesh.positions, along_x), cloth);
  const std::vector<Vec3> noise = test::random_vectors(mesh.vertex_count(), 0.03, 5);
  const std::vector<Vec3> stretched =
      test::sum(mapped(mesh.positions, Vec3(1.3, 1, 1.1).asDiagonal()), 1, noise);
  test::expect_elastic_energy_is_sound(energy, mesh.positions, stretched, 0.1);
  const std::vector<Vec3> crumpled =
      test::sum(mapped(mesh.positions, Vec3(0.7, 1, 0.8).asDiagonal()), 1, noise);
  test::expect_elastic_energy_is_sound(energy, mesh.positions, crumpled, 0.1);
}

TEST(MembraneEnergy, LargeSheetHasTheSameBitsForAnyThreadCount) {
  const Mesh mesh = test::flat_sheet(60, 50, 1, 1);
  const MembraneEnergy energy(build_shell(mesh, mesh.positions, along_x), cloth);
  test::expect_same_bits_for_any_thread_count(
      energy, test::sum(mesh.positions, 1, test::random_vectors(mesh.vertex_count(), 0.01, 5)));
}

TEST(MembraneEnergy, PulledStripHasTheModuliGiven) {
  // The width that costs least is found by Newton's method on differences of the energy.
  for (const bool along_warp : {true, false}) {
    const double stretch = 1 + 1e-4;
    const auto energy = [&](double width) {
      return along_warp ? density(cloth, stretch, width) : density(cloth, width, stretch);
    };
    double width = 1;
    for (int i = 0; i < 20; ++i) {
      const double d = 1e-5, up = energy(width + d), down = energy(width - d), here = energy(width);
      width -= (up - down) / 2 / ((up + down - 2 * here) / d);
    }
    const double modulus = along_warp ? cloth.warp : cloth.weft;
    EXPECT_NEAR(energy(width) / (0.5 * modulus * 1e-8), 1, 1e-3);
    // ν is the geometric mean of the two: the stiffer direction narrows the other one more.
    const double across = along_warp ? cloth.weft : cloth.warp;
    EXPECT_NEAR((1 - width) / (stretch - 1), cloth.poisson * std::sqrt(modulus / across), 2e-3);
  }
}

TEST(MembraneEnergy, ShearHasTheShearModulus) {
  EXPECT_NEAR(density(cloth, 1, 1, 1e-3) / (0.5 * cloth.shear * 1e-6), 1, 1e-5);
  MembraneModuli slack = cloth;
  slack.shear = 0;
  EXPECT_NEAR(density(slack, 1, 1, 0.3), 0, 1e-12);
}

TEST(MembraneEnergy, IsotropicSheetIsRotationInvariant) {
  const double poisson = 0.3;
  const MembraneModuli isotropic{700, 700, 700 / (2 * (1 + poisson)), poisson};
  const Mesh mesh = test::flat_sheet(3, 3, 0.3, 0.3);
  Mat3 f = Mat3::Identity();
  f(0, 0) = 1.2;
  f(0, 2) = 0.1;
  double first = 0;
  for (const double angle : {0.0, 0.4, 1.3}) {
    const Weave weave{Vec3(std::cos(angle), 0, std::sin(angle))};
    const MembraneEnergy energy(build_shell(mesh, mesh.positions, weave), isotropic);
    const double value = energy.value(mapped(mesh.positions, f));
    if (first == 0) first = value;
    EXPECT_NEAR(value / first, 1, 1e-12);
  }
}

TEST(MembraneEnergy, ProjectedStiffnessIsPositiveAndExactUnderTension) {
  const Mesh mesh = test::flat_sheet(4, 4, 0.4, 0.4);
  const MembraneEnergy energy(build_shell(mesh, mesh.positions, along_x), cloth);
  const std::vector<Vec3> noise = test::random_vectors(mesh.vertex_count(), 0.004, 5);
  for (const double stretch : {0.8, 1.3}) {
    const std::vector<Vec3> x = test::sum(mapped(mesh.positions, stretch * Mat3::Identity()), 1, noise);
    bool indefinite = false;
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const std::vector<Vec3> p = test::random_vectors(x.size(), 1, seed);
      std::vector<Vec3> out_of_plane = p;
      for (Vec3& d : out_of_plane) d = Vec3(0, d.y(), 0);
      for (const auto& d : {p, out_of_plane}) {
        std::vector<Vec3> y(x.size(), Vec3::Zero()), exact = y;
        energy.add_stiffness_product(Stiffness::projected, x, d, y);
        energy.add_stiffness_product(Stiffness::exact, x, d, exact);
        EXPECT_GE(test::inner(d, y), 0);
        EXPECT_GE(test::inner(d, y), test::inner(d, exact) - 1e-9);
        indefinite = indefinite || test::inner(d, exact) < 0;
        if (stretch > 1) {
          EXPECT_LT(test::norm(test::sum(y, -1, exact)), 1e-12 * test::norm(y));
        }
      }
    }
    EXPECT_EQ(indefinite, stretch < 1);
  }
}

/// M + scale K as the inner solver has it, for a sheet that is not the first body.
Eigen::MatrixXd matrix(const MembraneEnergy& energy, const std::vector<double>& masses, double scale,
                       const std::vector<Vec3>& x) {
  constexpr std::size_t others = 3;
  std::vector<double> all(others, 1e6);
  all.insert(all.end(), masses.begin(), masses.end());
  const std::vector<std::uint8_t> fixed(all.size(), 0);
  Linearization h;
  h.reset(all, fixed, scale);
  energy.linearize(x, h, others);
  h.finish();
  const auto n = static_cast<Eigen::Index>(3 * x.size());
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<Vec3> unit(all.size(), Vec3::Zero());
    unit[others + static_cast<std::size_t>(i / 3)][i % 3] = 1;
    const std::vector<Vec3> column = test::product(h, unit);
    for (Eigen::Index j = 0; j < n; ++j)
      result(j, i) = column[others + static_cast<std::size_t>(j / 3)][j % 3];
  }
  return result;
}

/// The least eigenvalue of h beside the masses.
double least_share(const Eigen::MatrixXd& h, const std::vector<double>& masses) {
  Eigen::VectorXd m(h.rows());
  for (Eigen::Index i = 0; i < m.size(); ++i) m[i] = masses[static_cast<std::size_t>(i / 3)];
  const Eigen::VectorXd root = m.cwiseSqrt().cwiseInverse();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(root.asDiagonal() * h * root.asDiagonal())
      .eigenvalues()[0];
}

TEST(MembraneEnergy, MatrixIsTheExactHessianWhereMassesOutweighCompression) {
  const Mesh mesh = test::flat_sheet(6, 5, 0.6, 0.5);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  const MembraneEnergy energy(shell, cloth, block_pattern(shell));
  const std::vector<Vec3> x = test::sum(mapped(mesh.positions, 0.98 * Mat3::Identity()), 1,
                                        test::random_vectors(mesh.vertex_count(), 1e-3, 5));
  const double scale = 1e-5, mass = 0.1;
  const std::vector<double> masses(x.size(), mass);
  const Eigen::MatrixXd h = matrix(energy, masses, scale, x);
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    std::vector<Vec3> p = test::random_vectors(x.size(), 1, seed);
    for (Vec3& d : p) d = Vec3(0.01 * d.x(), d.y(), 0.01 * d.z());
    std::vector<Vec3> exact(x.size(), Vec3::Zero()), projected = exact, whole = exact;
    energy.add_stiffness_product(Stiffness::exact, x, p, exact);
    energy.add_stiffness_product(Stiffness::projected, x, p, projected);
    Eigen::VectorXd q(h.rows());
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = p[static_cast<std::size_t>(i / 3)][i % 3];
    const Eigen::VectorXd hq = h * q;
    for (Eigen::Index i = 0; i < q.size(); ++i) whole[static_cast<std::size_t>(i / 3)][i % 3] = hq[i];
    const double error = test::norm(test::sum(test::sum(whole, -mass, p), -scale, exact));
    const double buckling = scale * test::norm(test::sum(exact, -1, projected));
    EXPECT_LT(error, 1e-3 * buckling);
  }
}

TEST(MembraneEnergy, MatrixAndMassesAreAtLeastATenthOfTheMasses) {
  // Sheets of unequal masses, pressed little and much; every direction by its eigenvalue.
  const Mesh mesh = test::flat_sheet(4, 3, 0.4, 0.3);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  const MembraneEnergy energy(shell, cloth, block_pattern(shell));
  for (const double stretch : {0.99, 0.9, 0.6}) {
    const std::vector<Vec3> x = test::sum(mapped(mesh.positions, stretch * Mat3::Identity()), 1,
                                          test::random_vectors(mesh.vertex_count(), 0.01, 7));
    for (const double mass : {1e-3, 1e-2}) {
      std::vector<double> masses(x.size(), mass);
      for (std::size_t v = 0; v < masses.size(); ++v) masses[v] *= 1 + static_cast<double>(v % 3);
      const double least = least_share(matrix(energy, masses, 1e-4, x), masses);
      EXPECT_GE(least, 0.1 - 1e-3) << stretch << ' ' << mass;
      EXPECT_LT(least, 0.9) << "some of what buckles is in it";
    }
  }
}

TEST(MembraneEnergy, TriangleCompressedAlongOneAxisUsesNineTenthsOfTheMasses) {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0, 0, 0.1)};
  mesh.face_offsets = {0, 3};
  mesh.face_vertices = {0, 1, 2};
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  const MembraneEnergy energy(shell, {1000, 1000, 400, 0}, block_pattern(shell));
  std::vector<Vec3> x = mesh.positions;
  x[1].x() = 0.08;
  const std::vector<double> masses(3, 1e-3);
  EXPECT_NEAR(least_share(matrix(energy, masses, 1e-4, x), masses), 0.1, 1e-4);
}

TEST(MembraneEnergy, MatrixIsProjectedWhereFloatLosesTheMasses) {
  const Mesh mesh = test::flat_sheet(4, 3, 0.4, 0.3);
  const Shell shell = build_shell(mesh, mesh.positions, along_x);
  const MembraneEnergy energy(shell, cloth, block_pattern(shell));
  const std::vector<Vec3> x = mapped(mesh.positions, 0.9 * Mat3::Identity());
  const std::vector<double> masses(x.size(), 1e-6);
  EXPECT_GE(least_share(matrix(energy, masses, 1e-4, x), masses), 0.9);
}

}  // namespace
}  // namespace muslin
