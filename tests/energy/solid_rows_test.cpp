// Solids by rows of voxels against the same elements one by one, on lattices with gaps and with rows longer
// than a piece, for a law that takes one logarithm per voxel and for one that does not.
#include "muslin/energy/solid_rows.hpp"

#include <cmath>
#include <cstring>

#include "support/lattice_box.hpp"
#include "support/linearized_product.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"
#include "muslin/energy/elements_methods.hpp"
#include "muslin/energy/neo_hookean_energy.hpp"
#include "muslin/energy/solid_rows_methods.hpp"

namespace muslin {

/// ψ = E ((I_C − 3)²/4 + (J − 1)²/2 + ln(I_C/3)/9). In an anonymous namespace GCC 12 warns falsely that its
/// elements read what is not set.
struct PlainLaw {
  struct Constants {
    double modulus;
  };
  static Constants constants(double youngs_modulus, double) { return {youngs_modulus}; }

  MUSLIN_INLINE static double energy(const Constants& c, double ic, double j) {
    return c.modulus * (0.25 * (ic - 3) * (ic - 3) + 0.5 * (j - 1) * (j - 1) + std::log(ic / 3) / 9);
  }
  template <class Real>
  MUSLIN_INLINE static Real shear(const Constants& c, Real ic) {
    return static_cast<Real>(c.modulus) * (ic - 3 + 2 / (9 * ic));
  }
  template <class Real>
  MUSLIN_INLINE static Real growth(const Constants& c, Real ic) {
    return static_cast<Real>(c.modulus) * (2 - 4 / (9 * ic * ic));
  }
  template <class Real>
  MUSLIN_INLINE static Real slope(const Constants& c, Real j) {
    return static_cast<Real>(c.modulus) * (j - 1);
  }
  template <class Real>
  MUSLIN_INLINE static Real curvature(const Constants& c, Real) {
    return static_cast<Real>(c.modulus);
  }
};

namespace {

static_assert(solid_rows::HasLogarithm<NeoHookeanLaw> && !solid_rows::HasLogarithm<PlainLaw>);

/// A box without its voxels at which `gap` is true.
template <class Gap>
Lattice with_gaps(const Vec3i& extent, const Gap& gap) {
  const Lattice whole = test::box_lattice(extent, 0.1);
  Lattice lattice;
  lattice.width = whole.width;
  lattice.extent = extent;
  std::vector<int> number(whole.vertex_count(), -1);
  for (std::size_t v = 0; v < whole.voxel_count(); ++v)
    if (!gap(whole.voxels[v]))
      for (const int corner : whole.voxel_vertices[v]) number[static_cast<std::size_t>(corner)] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(lattice.vertices.size());
    lattice.vertices.push_back(whole.vertices[v]);
  }
  for (std::size_t v = 0; v < whole.voxel_count(); ++v) {
    if (gap(whole.voxels[v])) continue;
    lattice.voxels.push_back(whole.voxels[v]);
    lattice.fill.push_back(0.3 + 0.7 * static_cast<double>(v % 5) / 4);
    auto corners = whole.voxel_vertices[v];
    for (int& corner : corners) corner = number[static_cast<std::size_t>(corner)];
    lattice.voxel_vertices.push_back(corners);
  }
  return lattice;
}

std::vector<Lattice> lattices() {
  return {with_gaps({1, 1, 1}, [](const Vec3i&) { return false; }),
          with_gaps({70, 3, 4}, [](const Vec3i&) { return false; }),
          with_gaps({9, 30, 12}, [](const Vec3i& at) { return (at.x() + 2 * at.y() + at.z()) % 7 == 0; }),
          with_gaps({40, 8, 6}, [](const Vec3i& at) { return at.x() > 20 && at.y() > 3; })};
}

void expect_equal(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double tolerance) {
  EXPECT_GT(test::norm(b), 0);
  EXPECT_LE(test::norm(test::sum(a, -1, b)), tolerance * test::norm(b));
}

template <class Law>
struct Solid {
  using ByElement = Elements<TetrahedronStencil, Law>;

  explicit Solid(const Lattice& lattice)
      : energy(lattice, {1e5, 0.3}, tetrahedron_pattern(lattice)), x(test::rest_positions(lattice)) {
    const std::vector<Vec3> noise = test::random_vectors(x.size(), 0.02, 4);
    for (std::size_t v = 0; v < x.size(); ++v) x[v] += noise[v] + Vec3(0, 0.1 * x[v].x(), 0);
  }

  SolidEnergy<Law> energy;
  std::vector<Vec3> x;
};

template <class Law>
class SolidRowsTest : public testing::Test {
 protected:
  template <class Body>
  static void for_each_solid(const Body& body) {
    for (const Lattice& lattice : lattices()) {
      SCOPED_TRACE(testing::Message() << lattice.extent.transpose());
      body(Solid<Law>(lattice));
    }
  }
};

using Laws = testing::Types<NeoHookeanLaw, PlainLaw>;
TYPED_TEST_SUITE(SolidRowsTest, Laws);

TYPED_TEST(SolidRowsTest, HaveTheEnergyAndForcesOfTheElements) {
  this->for_each_solid([](const Solid<TypeParam>& solid) {
    std::vector<Vec3> rows(solid.x.size(), Vec3::Zero()), elements = rows;
    const double energy = solid.energy.add_gradient_and_value(solid.x, rows);
    EXPECT_EQ(energy, solid.energy.value(solid.x));
    EXPECT_NEAR(energy / solid.energy.Solid<TypeParam>::ByElement::add_gradient_and_value(solid.x, elements),
                1, 1e-12);
    expect_equal(rows, elements, 1e-12);
  });
}

TYPED_TEST(SolidRowsTest, HaveTheStiffnessOfTheElements) {
  this->for_each_solid([](const Solid<TypeParam>& solid) {
    const std::vector<Vec3> p = test::random_vectors(solid.x.size(), 1, 7);
    for (const Stiffness kind : {Stiffness::exact, Stiffness::material}) {
      std::vector<Vec3> rows(p.size(), Vec3::Zero()), elements = rows;
      solid.energy.add_stiffness_product(kind, solid.x, p, rows);
      solid.energy.Solid<TypeParam>::ByElement::add_stiffness_product(kind, solid.x, p, elements);
      expect_equal(rows, elements, 1e-12);
    }
  });
}

TYPED_TEST(SolidRowsTest, GiveTheLinearSystemTheSumOfBothKinds) {
  this->for_each_solid([](const Solid<TypeParam>& solid) {
    const std::vector<double> masses(solid.x.size(), 1e-9);
    const std::vector<std::uint8_t> fixed(solid.x.size(), 0);
    Linearization h;
    h.reset(masses, fixed, 1);
    solid.energy.linearize(solid.x, h, 0);
    solid.energy.linearize_stiffness(Stiffness::material, solid.x, 0.5, h, 0);
    h.finish();
    const std::vector<Vec3> p = test::random_vectors(solid.x.size(), 1, 8);
    std::vector<Vec3> exact(p.size(), Vec3::Zero()), material = exact;
    solid.energy.add_stiffness_product(Stiffness::exact, solid.x, p, exact);
    solid.energy.add_stiffness_product(Stiffness::material, solid.x, p, material);
    expect_equal(test::product(h, p), test::sum(exact, 0.5, material), 2e-6);
  });
}

TYPED_TEST(SolidRowsTest, HaveTheSameBitsForAnyThreadCount) {
  this->for_each_solid([](const Solid<TypeParam>& solid) {
    std::vector<std::vector<Vec3>> forces;
    std::vector<double> energies;
    for (const int threads : {1, 2, 5}) {
      set_thread_count(threads);
      forces.emplace_back(solid.x.size(), Vec3::Zero());
      energies.push_back(solid.energy.add_gradient_and_value(solid.x, forces.back()));
    }
    set_thread_count(0);
    for (std::size_t i = 1; i < forces.size(); ++i) {
      EXPECT_EQ(energies[i], energies[0]);
      EXPECT_EQ(std::memcmp(forces[i].data(), forces[0].data(), solid.x.size() * sizeof(Vec3)), 0);
    }
  });
}

/// The six arguments of a voxel are some 1e60 each, so that their product would overflow.
TEST(SolidRows, HaveAFiniteEnergyWhereAStepHasGoneAstray) {
  Solid<NeoHookeanLaw> solid(test::box_lattice({3, 3, 3}, 0.1));
  for (Vec3& x : solid.x) x *= 1e30;
  const double energy = solid.energy.value(solid.x);
  EXPECT_NEAR(energy / solid.energy.Solid<NeoHookeanLaw>::ByElement::value(solid.x), 1, 1e-12);
}

}  // namespace
}  // namespace muslin
