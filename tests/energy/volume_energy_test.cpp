// Volume conservation: derivatives, rest state, what it resists and what it does not, and that a crushed or
// inverted body comes back.
#include "muslin/energy/volume_energy.hpp"

#include <cmath>

#include "support/lattice_box.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

namespace muslin {
namespace {

std::vector<Vec3> mapped(const std::vector<Vec3>& rest, const Mat3& f) {
  std::vector<Vec3> x = rest;
  for (Vec3& p : x) p = f * p;
  return x;
}

TEST(VolumeEnergy, PassesTheBatteryDeformedAndInverted) {
  Lattice lattice = test::box_lattice({3, 2, 3}, 0.5);
  for (std::size_t i = 0; i < lattice.fill.size(); ++i) lattice.fill[i] = 0.1 + 0.05 * static_cast<double>(i);
  const std::vector<Vec3> rest = test::rest_positions(lattice);
  const VolumeEnergy energy(lattice, 700);
  const std::vector<Vec3> noise = test::random_vectors(rest.size(), 0.15, 5);
  test::expect_elastic_energy_is_sound(energy, rest, test::sum(rest, 1, noise), 0.1);
  const std::vector<Vec3> inverted = mapped(rest, Vec3(1, -0.5, 1.2).asDiagonal());
  test::expect_elastic_energy_is_sound(energy, rest, test::sum(inverted, 1, noise), 0.1);
}

TEST(VolumeEnergy, LargeBodyHasTheSameBitsForAnyThreadCount) {
  const Lattice lattice = test::box_lattice({40, 12, 13});
  const std::vector<Vec3> rest = test::rest_positions(lattice);
  const VolumeEnergy energy(lattice, 1);
  const std::vector<Vec3> x = test::sum(rest, 1, test::random_vectors(rest.size(), 0.3, 5));
  test::expect_same_bits_for_any_thread_count(energy, x);
}

TEST(VolumeEnergy, UniformDeformationHasTheClosedForm) {
  // Fill counts as volume: a half-filled voxel stores half.
  Lattice lattice = test::box_lattice({2, 3, 4}, 0.25);
  for (double& f : lattice.fill) f = 0.5;
  const std::vector<Vec3> rest = test::rest_positions(lattice);
  const double volume = 2 * 3 * 4 * std::pow(0.25, 3);
  const VolumeEnergy energy(lattice, 900);
  Mat3 f;
  f << 1.2, 0.3, -0.1, 0.1, 0.9, 0.2, 0, -0.2, 1.1;
  EXPECT_NEAR(energy.value(mapped(rest, f)), 0.5 * 900 * 0.5 * volume * std::pow(f.determinant() - 1, 2),
              1e-12);
  // Volume-preserving shear and stretch are free, as they are for a fluid.
  Mat3 shear = Mat3::Identity();
  shear(0, 1) = 2;
  EXPECT_NEAR(energy.value(mapped(rest, shear)), 0, 1e-20);
  EXPECT_NEAR(energy.value(mapped(rest, Vec3(2, 0.25, 2).asDiagonal())), 0, 1e-20);
  // Flat and turned inside out.
  EXPECT_NEAR(energy.value(mapped(rest, Vec3(1, 0, 1).asDiagonal())), 0.5 * 900 * 0.5 * volume, 1e-12);
  EXPECT_NEAR(energy.value(mapped(rest, Vec3(1, -1, 1).asDiagonal())), 0.5 * 900 * 0.5 * volume * 4, 1e-12);
}

TEST(VolumeEnergy, ActsAsABulkModulus) {
  // Small even compression: W/V = ½ κ (3ε)², as a bulk modulus κ would store.
  const Lattice lattice = test::box_lattice({2, 2, 2});
  const std::vector<Vec3> rest = test::rest_positions(lattice);
  const double strain = 1e-5;
  const double value = VolumeEnergy(lattice, 1000).value(mapped(rest, (1 - strain) * Mat3::Identity()));
  EXPECT_NEAR(value / (0.5 * 1000 * 8 * std::pow(3 * strain, 2)), 1, 1e-4);
}

TEST(VolumeEnergy, RestoresFlattenedAndInvertedVoxels) {
  const Lattice lattice = test::box_lattice({1, 1, 1});
  const std::vector<Vec3> rest = test::rest_positions(lattice);
  const VolumeEnergy energy(lattice, 1);
  for (const double height : {0.5, 0.0, -0.5}) {
    std::vector<Vec3> x = mapped(rest, Vec3(1, height, 1).asDiagonal());
    const std::vector<Vec3> g = test::gradient(energy, x);
    double lift = 0;
    for (std::size_t v = 0; v < rest.size(); ++v) lift -= g[v].y() * (2 * rest[v].y() - 1);
    EXPECT_GT(lift, 0.5) << height;  // what was the top is pushed up, the bottom down
  }
  // Down the gradient from inside out, all the way to the volume at rest.
  std::vector<Vec3> x =
      test::sum(mapped(rest, Vec3(1, -0.3, 1).asDiagonal()), 1, test::random_vectors(rest.size(), 0.02, 3));
  for (int i = 0; i < 400; ++i) x = test::sum(x, -0.3, test::gradient(energy, x));
  EXPECT_LT(energy.value(x), 1e-8);
}

TEST(VolumeEnergy, DiagonalBlocksAreThoseOfTheHessian) {
  const Lattice lattice = test::box_lattice({2, 1, 1});
  const std::vector<Vec3> rest = test::rest_positions(lattice);
  const std::vector<Vec3> x = test::sum(rest, 1, test::random_vectors(rest.size(), 0.3, 9));
  const VolumeEnergy energy(lattice, 5);
  std::vector<Mat3> blocks(x.size(), Mat3::Zero());
  energy.add_diagonal_blocks(x, blocks);
  for (std::size_t v = 0; v < x.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      std::vector<Vec3> unit(x.size(), Vec3::Zero());
      unit[v][c] = 1;
      EXPECT_LT((test::hessian_product(energy, x, unit)[v] - blocks[v].col(c)).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace muslin
