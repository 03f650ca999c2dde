// Every pair of law and stencil passes the same battery: one line a pair at the end, and all laws of solids.
#include "muslin/energy/elements.hpp"

#include <functional>
#include <memory>

#include "support/lattice_box.hpp"
#include "support/linearized_product.hpp"
#include "support/plastic_hinges.hpp"
#include "support/potential_battery.hpp"
#include "support/sheet.hpp"
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "muslin/energy/bending_friction.hpp"
#include "muslin/energy/measured_membrane.hpp"
#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/plastic_membrane.hpp"
#include "muslin/energy/plastic_springs.hpp"
#include "muslin/energy/shell_bending.hpp"
#include "muslin/energy/solid_laws.hpp"
#include "muslin/energy/stretch_limit.hpp"
#include "muslin/material/measured_sheet.hpp"

namespace muslin {
namespace {

/// An energy with its shape at rest and deformed shapes at which it stores energy.
struct Case {
  std::shared_ptr<const ElementEnergy> energy;
  std::vector<Vec3> rest;
  std::vector<std::vector<Vec3>> deformed;
  double size = 0.1;      ///< over which W changes much [m]
  bool majorizes = true;  ///< the projected stiffness is at least the exact one; hinges leave out ∇²θ
  bool coupled = false;   ///< blocks are those of a matrix that bounds the stiffness by half
  double share = 0;       ///< of the stiffness that linear systems have at least; 0: they have just it
  Stiffness linear = Stiffness::projected;  ///< the stiffness that linear systems get
};
struct Pair {
  std::string name;
  std::function<Case()> make;
};

std::vector<Vec3> mapped(std::vector<Vec3> x, const Mat3& f, double noise, std::uint32_t seed = 5) {
  const std::vector<Vec3> moves = test::random_vectors(x.size(), noise, seed);
  for (std::size_t v = 0; v < x.size(); ++v) x[v] = f * x[v] + moves[v];
  return x;
}

template <class Energy>
Case of_sheet(const Energy& make, const std::vector<Mat3>& maps, double noise) {
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  Case c{make(shell, block_pattern(shell)), mesh.positions, {}};
  for (const Mat3& map : maps) c.deformed.push_back(mapped(mesh.positions, map, noise));
  return c;
}

Mat3 scaled(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }

Case membrane() {
  return of_sheet(
      [](const Shell& shell, auto pattern) {
        return std::make_shared<MembraneEnergy>(shell, MembraneModuli{900, 500, 130, 0.25}, pattern);
      },
      {scaled(1.3, 1, 1.1), scaled(0.7, 1, 0.8)}, 0.03);
}

/// Both families of threads, one of them or none are buckled.
Case buckling_membrane() {
  return of_sheet(
      [](const Shell& shell, auto pattern) {
        return std::make_shared<MembraneEnergy>(shell, MembraneModuli{900, 500, 130, 0.25}, pattern,
                                                BucklingRigidity{0.02, 0.01});
      },
      {scaled(1.3, 1, 1.1), scaled(0.7, 1, 0.8), scaled(0.8, 1, 1.1), scaled(1.1, 1, 0.7)}, 0.005);
}

Case membrane_of_many_fabrics() {
  return of_sheet(
      [](const Shell& shell, auto pattern) {
        std::vector<MembraneModuli> moduli;
        for (std::size_t t = 0; t < shell.triangles.size(); ++t)
          moduli.push_back({500 + 10.0 * static_cast<double>(t), 700, 100, 0.1});
        return std::make_shared<MembraneEnergy>(shell, std::span<const MembraneModuli>(moduli), pattern);
      },
      {scaled(1.3, 1, 1.1), scaled(0.7, 1, 0.8)}, 0.03);
}

Case membrane_of_curves(const BucklingRigidity& rigidity, double noise) {
  return of_sheet(
      [&rigidity](const Shell& shell, auto pattern) {
        ShellMaterial material;
        material.warp_curve = {{0.05, 20}, {0.1, 60}, {0.2, 300}};
        material.weft_curve = {{0.04, 40}, {0.2, 100}, {0.4, 180}};
        material.shear_curve = {{2, 2}, {8, 12}, {20, 60}};
        return std::make_shared<MeasuredMembrane>(shell, stress_of(material), 0.25, pattern, rigidity);
      },
      {scaled(1.3, 1, 1.1), scaled(0.7, 1, 0.8), scaled(1.1, 1, 0.9)}, noise);
}
Case measured_membrane() { return membrane_of_curves({}, 0.03); }
Case buckling_measured_membrane() { return membrane_of_curves({0.02, 0.01}, 0.005); }

Case bending() {
  Case c = of_sheet(
      [](const Shell& shell, auto pattern) {
        return std::make_shared<ShellBending>(shell, BendingModuli{1e-4, 3e-5, 5e-5}, pattern);
      },
      {}, 0);
  c.majorizes = false;
  c.coupled = true;
  for (const double curvature : {0.5, 15.0})
    c.deformed.push_back(mapped(test::rolled(c.rest, curvature), Mat3::Identity(), 0.02));
  return c;
}

Case measured_bending() {
  Case c = bending();
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const StressCurve warp(std::vector<Vec2>{{5, 4e-4}, {10, 6e-4}, {20, 8e-4}}),
      weft(std::vector<Vec2>{{10, 1e-4}, {40, 9e-4}});
  c.energy =
      std::make_shared<ShellBending>(shell, BendingCurves{warp, weft, 6e-5, 0.25}, block_pattern(shell));
  c.share = 1;
  return c;
}

Case stretch_limit() {
  return of_sheet([](const Shell& shell,
                     auto pattern) { return std::make_shared<StretchLimitEnergy>(shell, 1.1, 700, pattern); },
                  {scaled(1.07, 1, 0.9), scaled(1.3, 1, 1.2)}, 0.005);
}

/// The energy of a first step, bent beyond the yield angle here and there.
Case plastic_hinges() {
  Case c = bending();
  c.coupled = false;
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const test::PlasticHinges load("hinges", shell, {1e-4, 3e-5, 5e-5}, {0.2, 0.3}, block_pattern(shell));
  std::shared_ptr<const Potential> energy = load.potential(StepContext());
  c.energy = std::dynamic_pointer_cast<const ElementEnergy>(energy);
  return c;
}

/// The energy of a first step, in which no thread, one or both yield.
Case plastic_membrane() {
  return of_sheet(
      [](const Shell& shell, auto pattern) {
        const PlasticMembrane load("cloth", shell, {900, 500, 130, 0.25}, {0.05, 0.2}, pattern);
        std::shared_ptr<const Potential> energy = load.potential(StepContext());
        return std::dynamic_pointer_cast<const ElementEnergy>(energy);
      },
      {scaled(1.3, 1, 1.1), scaled(0.7, 1, 0.8), scaled(1.3, 1, 0.8), scaled(1.02, 1, 1.02)}, 0.005);
}

/// The energy of a first step, with springs that yield here and there.
Case plastic_springs() {
  Lattice lattice = test::box_lattice({3, 2, 2});
  lattice.width = 0.1;
  std::vector<Vec3> rest;
  for (std::size_t v = 0; v < lattice.vertex_count(); ++v) rest.push_back(lattice.rest_position(v));
  const PlasticSprings load("block", build_springs(lattice, Bracing::kuhn), rest.size(), 0.1, {3e4, 1e4, 5e3},
                            {}, {0.1, 0.3});
  std::shared_ptr<const Potential> energy = load.potential(StepContext());
  return {std::dynamic_pointer_cast<const ElementEnergy>(energy),
          rest,
          {mapped(rest, scaled(1.3, 0.95, 1.05), 0.01), mapped(rest, scaled(0.7, 0.95, 1.2), 0.01)}};
}

/// The energy of a first step: sliders stick, or slip here and there.
Case bending_friction() {
  Case c = bending();
  c.share = 0.5;
  const Mesh mesh = test::flat_sheet(7, 6, 0.7, 0.6, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const BendingFriction load("cloth", shell, std::make_shared<HingeAngles>(shell, block_pattern(shell)),
                             {1e-4, 3e-5, 8});
  StepContext at_rest;
  at_rest.positions = mesh.positions;
  std::shared_ptr<const Potential> energy = load.potential(at_rest);
  c.energy = std::dynamic_pointer_cast<const ElementEnergy>(energy);
  return c;
}

Case solid(const SolidLaw& law, double poisson) {
  Lattice lattice = test::box_lattice({3, 2, 2});
  lattice.width = 0.1;
  for (std::size_t v = 0; v < lattice.fill.size(); ++v) lattice.fill[v] = 0.5 + 0.04 * static_cast<double>(v);
  std::vector<Vec3> rest;
  for (std::size_t v = 0; v < lattice.vertex_count(); ++v) rest.push_back(lattice.rest_position(v));
  Case c{law.make(lattice, SolidModuli{3e4, poisson}, tetrahedron_pattern(lattice)),
         rest,
         {mapped(rest, scaled(1.3, 0.9, 1.1), 0.01), mapped(rest, scaled(0.6, 0.8, 0.7), 0.01),
          mapped(rest, scaled(1, -0.5, 1), 0.02)}};
  c.linear = Stiffness::exact;
  return c;
}

/// Every law of solids, of a usual Poisson's ratio and near ½.
std::vector<Pair> solids() {
  std::vector<Pair> pairs;
  for (const SolidLaw& law : solid_laws())
    for (const int percent : {30, 49})
      pairs.push_back({fmt::format("{}_of_{}_percent", law.name, percent),
                       [&law, percent] { return solid(law, percent / 100.0); }});
  return pairs;
}

class ElementsBattery : public testing::TestWithParam<Pair> {};

TEST_P(ElementsBattery, DerivativesSymmetryRestStateRigidMotionsAndBits) {
  const Case c = GetParam().make();
  for (const auto& x : c.deformed) test::expect_elastic_energy_is_sound(*c.energy, c.rest, x, c.size);
}

/// M + K as the linear system has it, with masses that hold nothing.
std::vector<Vec3> linearized(const ElementEnergy& energy, const std::vector<Vec3>& x,
                             const std::vector<Vec3>& p) {
  const std::vector<double> masses(x.size(), 1e-9);
  const std::vector<std::uint8_t> fixed(x.size(), 0);
  Linearization h;
  h.reset(masses, fixed, 1);
  energy.linearize(x, h, 0);
  h.finish();
  return test::product(h, p);
}

TEST_P(ElementsBattery, BlocksProductsAndMatrixAgree) {
  const Case c = GetParam().make();
  for (const auto& x : c.deformed) {
    const std::vector<Vec3> p = test::random_vectors(x.size(), 1, 6);
    std::vector<Vec3> product(x.size(), Vec3::Zero());
    c.energy->add_stiffness_product(c.linear, x, p, product);
    const std::vector<Vec3> matrix = linearized(*c.energy, x, p);
    if (c.share > 0) {
      EXPECT_GE(test::inner(p, matrix), c.share * test::inner(p, product));
    } else {
      EXPECT_LE(test::norm(test::sum(matrix, -1, product)), 2e-6 * test::norm(product));
    }
    std::vector<Mat3> blocks(x.size(), Mat3::Zero());
    c.energy->add_stiffness_blocks(Stiffness::projected, x, blocks);
    for (std::size_t v = 0; v < x.size() && !c.coupled; v += 5) {
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<Vec3> unit(x.size(), Vec3::Zero()), column = unit;
        unit[v][axis] = 1;
        c.energy->add_stiffness_product(Stiffness::projected, x, unit, column);
        EXPECT_LE((column[v] - blocks[v].col(axis)).norm(), 1e-10 * (blocks[v].norm() + 1e-12));
      }
    }
  }
}

TEST_P(ElementsBattery, ProjectedStiffnessIsPositiveAndExceptForHingesAtLeastTheExactOne) {
  const Case c = GetParam().make();
  for (const auto& x : c.deformed) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      const std::vector<Vec3> p = test::random_vectors(x.size(), 1, seed);
      const auto work = [&](Stiffness kind) {
        std::vector<Vec3> y(x.size(), Vec3::Zero());
        c.energy->add_stiffness_product(kind, x, p, y);
        return test::inner(p, y);
      };
      const double exact = work(Stiffness::exact), projected = work(Stiffness::projected);
      EXPECT_GE(projected, 0);
      if (c.majorizes) {
        EXPECT_GE(projected, exact - 1e-9 * std::abs(exact));
      }
      EXPECT_GE(work(Stiffness::material), 0);
    }
  }
}

TEST_P(ElementsBattery, MaterialStiffnessDoesNotResistRotation) {
  const Case c = GetParam().make();
  for (const auto& x : c.deformed) {
    std::vector<Vec3> turning, y(x.size(), Vec3::Zero()), other = y;
    for (const Vec3& p : x) turning.push_back(Vec3(0.3, 0.5, 0.8).cross(p));
    c.energy->add_stiffness_product(Stiffness::material, x, turning, y);
    const std::vector<Vec3> any = test::random_vectors(x.size(), test::norm(turning), 3);
    c.energy->add_stiffness_product(Stiffness::material, x, any, other);
    EXPECT_LE(test::norm(y), 1e-9 * test::norm(other));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Pairs, ElementsBattery,
    testing::Values(Pair{"MembraneOnTriangles", membrane},
                    Pair{"BucklingMembraneOnTriangles", buckling_membrane},
                    Pair{"MembraneOfManyFabricsOnTriangles", membrane_of_many_fabrics},
                    Pair{"MeasuredMembraneOnTriangles", measured_membrane},
                    Pair{"BucklingMeasuredMembraneOnTriangles", buckling_measured_membrane},
                    Pair{"StretchLimitOnTriangles", stretch_limit}, Pair{"ShellBending", bending},
                    Pair{"PlasticHinges", plastic_hinges}, Pair{"BendingFriction", bending_friction},
                    Pair{"PlasticMembraneOnTriangles", plastic_membrane},
                    Pair{"PlasticSpringsOnBars", plastic_springs}, Pair{"MeasuredBending", measured_bending}),
    [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Solids, ElementsBattery, testing::ValuesIn(solids()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace muslin
