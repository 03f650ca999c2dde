// The Neo-Hookean solid: closed forms of the law, what the lattice adds to it, and inverted elements.
#include <cmath>

#include "support/lattice_box.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/energy/neo_hookean_energy.hpp"

namespace muslin {
namespace {

constexpr SolidModuli rubber{2e5, 0.35};
constexpr double mu = rubber.youngs_modulus / (2 * (1 + rubber.poisson));
constexpr double lame =
    rubber.youngs_modulus * rubber.poisson / ((1 + rubber.poisson) * (1 - 2 * rubber.poisson));

struct Block {
  Lattice lattice = test::box_lattice({3, 2, 4});
  std::vector<Vec3> rest;
  double volume = 0;

  explicit Block(double width = 0.1) {
    lattice.width = width;
    for (std::size_t v = 0; v < lattice.vertex_count(); ++v) rest.push_back(lattice.rest_position(v));
    for (const double fill : lattice.fill) volume += fill * width * width * width;
  }
  std::vector<Vec3> mapped(const Mat3& f) const {
    std::vector<Vec3> x = rest;
    for (Vec3& p : x) p = f * p;
    return x;
  }
  /// Energy per volume.
  double density(const Mat3& f) const { return NeoHookeanEnergy(lattice, rubber).value(mapped(f)) / volume; }
};

TEST(NeoHookean, SmallStrainsHaveTheEnergyOfLinearElasticity) {
  const Block block;
  const double e = 1e-4;
  Mat3 strain;
  strain << 1, 0.3, -0.2, 0.3, -0.7, 0.4, -0.2, 0.4, 0.5;
  const Mat3 f = Mat3::Identity() + e * strain;
  const double linear = mu * strain.squaredNorm() + lame / 2 * strain.trace() * strain.trace();
  EXPECT_NEAR(block.density(f) / (e * e * linear), 1, 1e-3);
}

TEST(NeoHookean, UniformStretchHasTheEnergyOfTheLawForAnyTetrahedron) {
  const Block block;
  const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Mat3 f;
  f << 1.4, 0.2, 0, -0.1, 0.8, 0.3, 0.1, 0, 1.1;
  const double j = f.determinant(), ic = f.squaredNorm(), m = 4.0 / 3 * mu, lambda = lame + 5.0 / 6 * mu;
  const double expected =
      m / 2 * (ic - 3 - std::log((ic + 1) / 4)) - 0.75 * m * (j - 1) + lambda / 2 * (j - 1) * (j - 1);
  EXPECT_NEAR(block.density(f), expected, 1e-10 * expected);
  EXPECT_NEAR(block.density(turn * f), expected, 1e-10 * expected);
}

TEST(NeoHookean, FillOfAVoxelScalesItsElements) {
  Block block;
  const double whole = block.density(Vec3(1.2, 1, 1).asDiagonal()) * block.volume;
  for (double& fill : block.lattice.fill) fill = 0.25;
  const double quarter =
      NeoHookeanEnergy(block.lattice, rubber).value(block.mapped(Vec3(1.2, 1, 1).asDiagonal()));
  EXPECT_NEAR(quarter / whole, 0.25, 1e-12);
}

TEST(NeoHookean, UniformStrainHasNoForceInside) {
  // The patch test: a uniform deformation of a lattice is in equilibrium at every inner vertex.
  const Block block;
  Mat3 f;
  f << 1.2, 0.3, 0, -0.1, 0.9, 0.2, 0.1, 0, 1.1;
  const NeoHookeanEnergy energy(block.lattice, rubber);
  const std::vector<Vec3> g = test::gradient(energy, block.mapped(f));
  int inner = 0;
  for (std::size_t v = 0; v < g.size(); ++v) {
    const Vec3i& at = block.lattice.vertices[v];
    if ((at.array() == 0).any() || (at.array() == block.lattice.extent.array()).any()) continue;
    ++inner;
    EXPECT_LE(g[v].norm(), 1e-10 * test::norm(g));
  }
  EXPECT_GT(inner, 0);
}

TEST(NeoHookean, InvertedFlatAndCollapsedElementsHaveFiniteForcesAndStiffness) {
  const Block block;
  const NeoHookeanEnergy energy(block.lattice, rubber, tetrahedron_pattern(block.lattice));
  for (const Vec3& scales :
       {Vec3(1, -0.7, 1), Vec3(1, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(-1, -1, -1)}) {
    const std::vector<Vec3> x = block.mapped(scales.asDiagonal());
    EXPECT_TRUE(std::isfinite(energy.value(x)));
    const std::vector<Vec3> p = test::random_vectors(x.size(), 1, 3);
    for (const Stiffness kind : {Stiffness::exact, Stiffness::projected, Stiffness::material}) {
      std::vector<Vec3> y(x.size(), Vec3::Zero());
      energy.add_stiffness_product(kind, x, p, y);
      for (const Vec3& v : y) EXPECT_TRUE(v.allFinite());
    }
    for (const Vec3& g : test::gradient(energy, x)) EXPECT_TRUE(g.allFinite());
  }
}

TEST(NeoHookean, InvertedBlockHasARestoringForce) {
  // W falls all the way from a mirrored block to the one at rest.
  const Block block;
  double last = INFINITY;
  for (double scale = -1; scale <= 1.001; scale += 0.1) {
    const double density = block.density(Vec3(1, 1, scale).asDiagonal());
    EXPECT_LT(density, last) << scale;
    last = density;
  }
  EXPECT_NEAR(last, 0, 1e-9 * mu);
}

TEST(NeoHookean, RefusesModuliOutOfRange) {
  const Block block;
  EXPECT_THROW(NeoHookeanEnergy(block.lattice, {0, 0.3}), Error);
  EXPECT_THROW(NeoHookeanEnergy(block.lattice, {1e5, 0.5}), Error);
  EXPECT_THROW(NeoHookeanEnergy(block.lattice, {1e5, -1}), Error);
}

}  // namespace
}  // namespace muslin
