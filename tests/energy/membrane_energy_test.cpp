// Stretch and shear of shells: derivatives, closed forms of the moduli, threads that follow the weave.
#include "muslin/energy/membrane_energy.hpp"

#include <cmath>
#include <numbers>

#include "support/sheet.hpp"
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

TEST(MembraneEnergy, ShearHasItsOwnModulus) {
  EXPECT_NEAR(density(cloth, 1, 1, 1e-3) / (0.5 * cloth.shear * 1e-6), 1, 1e-5);
  MembraneModuli slack = cloth;
  slack.shear = 0;
  EXPECT_NEAR(density(slack, 1, 1, 0.3), 0, 1e-12);
}

TEST(MembraneEnergy, IsotropicSheetCaresForNoDirection) {
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

}  // namespace
}  // namespace muslin
