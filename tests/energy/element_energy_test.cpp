// Damping of shells: derivatives, what it slows down and what it leaves alone.
#include "muslin/energy/element_energy.hpp"

#include "support/linearized_product.hpp"
#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/energy/membrane_energy.hpp"
#include "muslin/energy/shell_bending.hpp"

namespace muslin {
namespace {

struct Moving {
  std::vector<Vec3> positions, velocities;
  StepContext context;

  Moving(std::vector<Vec3> x, std::vector<Vec3> v, double dt)
      : positions(std::move(x)), velocities(std::move(v)) {
    context.time_end = context.dt = context.length = dt;
    context.velocity_time = dt / 2;
    context.anchor = positions;
    context.positions = positions;
    context.velocities = velocities;
  }
};

std::vector<std::shared_ptr<ElementEnergy>> energies(const Mesh& mesh) {
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  return {std::make_shared<MembraneEnergy>(shell, MembraneModuli{900, 500, 130, 0.25}),
          std::make_shared<ShellBending>(shell, BendingModuli{1e-3, 3e-4, 5e-4})};
}

TEST(ElementDamping, PassesTheBattery) {
  const Mesh mesh = test::flat_sheet(5, 4, 0.5, 0.4, 0.2);
  const std::vector<Vec3> x =
      test::sum(test::rolled(mesh.positions, 3), 1, test::random_vectors(mesh.vertex_count(), 0.01, 5));
  for (const auto& energy : energies(mesh)) {
    Moving moving(x, test::random_vectors(x.size(), 0.1, 6), 0.01);
    const auto damping = ElementDamping(energy, 0.003).potential(moving.context);
    test::expect_potential_is_sound(*damping, test::sum(x, 1, test::random_vectors(x.size(), 0.01, 7)), 0.1);
    EXPECT_EQ(ElementDamping(energy, 0).potential(moving.context), nullptr);
  }
}

TEST(ElementDamping, DoesNotDampFreeFallAndRotation) {
  const Mesh mesh = test::flat_sheet(5, 4, 0.5, 0.4);
  const double dt = 1e-3, spin = 2;
  std::vector<Vec3> turning, strained;
  for (const Vec3& p : mesh.positions) {
    turning.push_back(Vec3(1, -2, 3) + spin * Vec3(0.3, 0.5, 0.8).cross(p));
    strained.push_back(Vec3(p.x(), p.x() * p.x(), 0));
  }
  for (const auto& energy : energies(mesh)) {
    const auto force = [&](const std::vector<Vec3>& velocities) {
      Moving moving(mesh.positions, velocities, dt);
      const auto damping = ElementDamping(energy, 0.01).potential(moving.context);
      return test::norm(test::gradient(*damping, test::sum(mesh.positions, dt, velocities)));
    };
    EXPECT_LT(force(turning), 5e-3 * force(strained));  // the chord of an arc is longer by (spin dt)²/2
    EXPECT_GT(force(strained), 0);
  }
}

TEST(ElementDamping, IsRayleighs) {
  // The force is β times the change of the elastic force per time.
  const Mesh mesh = test::flat_sheet(5, 4, 0.5, 0.4);
  const double dt = 1e-3, beta = 0.02;
  const std::vector<Vec3> velocities = test::random_vectors(mesh.vertex_count(), 1e-4, 8);
  for (const auto& energy : energies(mesh)) {
    Moving moving(mesh.positions, velocities, dt);
    const auto damping = ElementDamping(energy, beta).potential(moving.context);
    const std::vector<Vec3> end = test::sum(mesh.positions, dt, velocities);
    const std::vector<Vec3> force = test::gradient(*damping, end);
    const std::vector<Vec3> rate = test::hessian_product(*energy, mesh.positions, velocities);
    EXPECT_LT(test::norm(test::sum(force, -beta, rate)), 1e-4 * test::norm(force));
  }
}

TEST(ElementEnergy, MatrixIsTheProjectedStiffnessWithoutMasses) {
  const Mesh mesh = test::flat_sheet(30, 25, 0.6, 0.5, 0.2);
  const Shell shell = build_shell(mesh, mesh.positions, {Vec3::UnitX()});
  const auto pattern = block_pattern(shell);
  const MembraneEnergy membrane(shell, {900, 500, 130, 0.25}, pattern);
  const ShellBending bending(shell, {1e-3, 3e-4, 5e-4}, pattern);
  const std::vector<Vec3> x =
      test::sum(test::rolled(mesh.positions, 3), 1, test::random_vectors(mesh.vertex_count(), 0.004, 5));
  const std::vector<double> masses(x.size(), 1e-6);
  const std::vector<std::uint8_t> fixed(x.size(), 0);
  const std::vector<Vec3> p = test::random_vectors(x.size(), 1, 6);
  for (const auto& energies :
       {std::vector<const ElementEnergy*>{&membrane}, {&bending}, {&membrane, &bending}}) {
    Linearization h;
    h.reset(masses, fixed, 0.5);
    for (const ElementEnergy* energy : energies) energy->linearize(x, h, 0);
    h.finish();
    const std::vector<Vec3> product = test::product(h, p);
    std::vector<Vec3> expected(x.size(), Vec3::Zero());
    for (const ElementEnergy* energy : energies)
      energy->add_stiffness_product(Stiffness::projected, x, p, expected);
    double difference = 0, norm = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
      expected[v] = 0.5 * expected[v] + 1e-6 * p[v];
      difference += (expected[v] - product[v]).squaredNorm();
      norm += expected[v].squaredNorm();
    }
    EXPECT_LT(std::sqrt(difference / norm), 1e-6);
    // The diagonal blocks are those that the energies give one by one.
    std::vector<Mat3> blocks(x.size(), Mat3::Zero());
    for (const ElementEnergy* energy : energies) energy->add_diagonal_blocks(x, blocks);
    for (std::size_t v = 0; v < x.size(); v += 50)
      EXPECT_NEAR(h.remainder_upper().data().y[v], 0.5 * blocks[v](0, 1), 1e-5 * blocks[v].norm());
  }
}

}  // namespace
}  // namespace muslin
