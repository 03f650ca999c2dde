// Lattice springs and their dashpots: counts, forces by hand, derivatives, rest state, rigid motions,
// degenerate lengths.
#include "muslin/energy/spring_energy.hpp"

#include <cmath>
#include <cstdint>
#include <memory>

#include "support/lattice_box.hpp"
#include "support/linearized_product.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/energy/spring_damping.hpp"

namespace muslin {
namespace {

constexpr std::array<double, 3> flag_moduli = {20000, 100, 100};

std::vector<Vec3> crumpled(const std::vector<Vec3>& rest, double size) {
  return test::sum(rest, 1, test::random_vectors(rest.size(), size, 5));
}

TEST(SpringEnergy, BoxLatticesHaveTheFlagsCounts) {
  const Springs springs = build_springs(test::box_lattice({10, 6, 1}), Bracing::kuhn);
  EXPECT_EQ(springs.count_by_kind, (std::array<std::int64_t, 3>{349, 256, 60}));
}

TEST(SpringEnergy, PassesTheBatteryStretchedAndCompressed) {
  const Lattice lattice = test::box_lattice({4, 3, 2}, 0.5);
  const std::vector<Vec3> rest = test::rest_positions(lattice);
  const Springs springs = build_springs(lattice, Bracing::kuhn);
  std::vector<float> weights;
  for (std::int64_t s = 0; s < springs.count; ++s)
    weights.push_back(0.25F + 0.5F * static_cast<float>(s % 3));
  for (const std::vector<float>& w : {std::vector<float>{}, weights}) {
    const SpringEnergy energy(springs, lattice.width, {200, 30, 10}, w);
    test::expect_elastic_energy_is_sound(energy, rest, crumpled(rest, 0.1), 0.1);
    std::vector<Vec3> squeezed = crumpled(rest, 0.02);
    for (Vec3& p : squeezed) p *= 0.7;
    test::expect_elastic_energy_is_sound(energy, rest, squeezed, 0.1);
  }
}

/// Lattices of several slabs with springs between them: one of long rows, whose edges along x overlap, and
/// one of rows short enough to be joined across the gaps between springs.
class SpringSlabsTest : public testing::TestWithParam<Vec3i> {
 protected:
  const Lattice lattice_ = test::box_lattice(GetParam());
  const std::vector<Vec3> rest_ = test::rest_positions(lattice_);
  const Springs springs_ = build_springs(lattice_, Bracing::kuhn);

  /// Calls body(a, b, k, r) for one spring at a time.
  template <class Body>
  void for_each_spring(const Body& body) const {
    for (const SpringRun& run : springs_.runs) {
      const SpringDirection& direction = springs_.directions[static_cast<std::size_t>(run.direction)];
      for (int i = 0; i < run.length; ++i) {
        body(static_cast<std::size_t>(run.a + i), static_cast<std::size_t>(run.b + i),
             flag_moduli[static_cast<std::size_t>(direction.kind)], direction.offset.cast<double>().norm());
      }
    }
  }
};

TEST_P(SpringSlabsTest, SpringsPullAsOneSpringAtATime) {
  const SpringEnergy energy(springs_, 1, flag_moduli);
  const std::vector<Vec3> x = crumpled(rest_, 0.3), p = test::random_vectors(x.size(), 1, 8);
  std::vector<Vec3> force(x.size(), Vec3::Zero()), product = force;
  double value = 0;
  for_each_spring([&](std::size_t a, std::size_t b, double k, double r) {
    const Vec3 z = x[b] - x[a], n = z.normalized();
    value += 0.5 * k * std::pow(z.norm() - r, 2);
    const Vec3 f = k * (z.norm() - r) * n;
    force[b] += f, force[a] -= f;
    const double along = n.dot(p[b] - p[a]);
    const Vec3 change = k * along * n + k * (1 - r / z.norm()) * (p[b] - p[a] - along * n);
    product[b] += change, product[a] -= change;
  });
  EXPECT_NEAR(energy.value(x), value, 1e-12 * value);
  const std::vector<Vec3> g = test::gradient(energy, x), y = test::hessian_product(energy, x, p);
  for (std::size_t v = 0; v < x.size(); ++v) {
    ASSERT_LE((g[v] - force[v]).norm(), 1e-8);
    ASSERT_LE((y[v] - product[v]).norm(), 1e-8);
  }
  test::expect_one_pass_is_two(energy, x);
  test::expect_same_bits_for_any_thread_count(energy, x);
}

TEST_P(SpringSlabsTest, DashpotsPullAsOneDashpotAtATime) {
  const double beta = 0.02, dt = 0.1;
  const auto energy = std::make_shared<SpringEnergy>(springs_, 1, flag_moduli);
  StepContext step;
  step.time_end = step.dt = dt;
  step.anchor = crumpled(rest_, 0.1);
  step.positions = rest_;
  const std::vector<Vec3> velocities(rest_.size(), Vec3::Zero());
  step.velocities = velocities;
  const auto damping = SpringDamping(energy, beta).potential(step);
  const std::vector<Vec3> x = crumpled(rest_, 0.3);
  std::vector<Vec3> force(x.size(), Vec3::Zero());
  double value = 0;
  for_each_spring([&](std::size_t a, std::size_t b, double k, double) {
    const Vec3 n = (rest_[b] - rest_[a]).normalized();
    const double change = n.dot(x[b] - x[a] - step.anchor[b] + step.anchor[a]);
    value += 0.5 * beta * k / dt * change * change;
    force[b] += beta * k / dt * change * n, force[a] -= beta * k / dt * change * n;
  });
  EXPECT_NEAR(damping->value(x), value, 1e-12 * value);
  const std::vector<Vec3> g = test::gradient(*damping, x);
  for (std::size_t v = 0; v < x.size(); ++v) ASSERT_LE((g[v] - force[v]).norm(), 1e-9);
  test::expect_one_pass_is_two(*damping, x);
  test::expect_same_bits_for_any_thread_count(*damping, x);
}

TEST_P(SpringSlabsTest, LinearizedSpringsAndDashpotsHaveTheirHessian) {
  const auto energy = std::make_shared<SpringEnergy>(springs_, 1, flag_moduli);
  const std::vector<Vec3> x = crumpled(rest_, 0.1), velocities(rest_.size(), Vec3::Zero());
  StepContext step;
  step.time_end = step.dt = 0.1;
  step.anchor = x;
  step.positions = x;  // dashpots along the springs themselves
  step.velocities = velocities;
  const auto damping = SpringDamping(energy, 0.02).potential(step);
  const std::vector<double> masses(x.size(), 1.0);
  const std::vector<std::uint8_t> fixed(x.size(), 0);
  const double scale = 0.01;
  Linearization linearization;
  linearization.reset(masses, fixed, scale);
  energy->linearize(x, linearization, 0);
  damping->linearize(x, linearization, 0);
  linearization.finish();

  const std::vector<Vec3> p = test::random_vectors(x.size(), 1, 9);
  const std::vector<Vec3> linearized = test::product(linearization, p);
  std::vector<Vec3> y(x.size(), Vec3::Zero());
  energy->add_hessian_product(x, p, y);
  damping->add_hessian_product(x, p, y);
  for (std::size_t v = 0; v < x.size(); ++v) {
    const Vec3 expected = p[v] + scale * y[v];
    // Couplings across the springs are stored with 8 bits.
    ASSERT_LE((linearized[v] - expected).norm(), 3e-3 * scale * flag_moduli[0]) << v;
  }
}

INSTANTIATE_TEST_SUITE_P(Boxes, SpringSlabsTest,
                         testing::Values(Vec3i(60, 40, 1), Vec3i(12, 30, 9), Vec3i(700, 4, 1)));

TEST(SpringEnergy, CollapsedSpringStoresEnergyWithoutNan) {
  const Lattice lattice = test::box_lattice({1, 1, 1});
  const SpringEnergy energy(build_springs(lattice, Bracing::kuhn), 1, flag_moduli);
  const std::vector<Vec3> x(8, Vec3(1, 2, 3));
  EXPECT_NEAR(energy.value(x), 0.5 * (12 * 20000 + 6 * 100 * 2 + 1 * 100 * 3), 1e-6);
  const std::vector<Vec3> y = test::hessian_product(energy, x, test::random_vectors(8, 1, 1));
  for (std::size_t v = 0; v < 8; ++v) {
    EXPECT_EQ(test::gradient(energy, x)[v], Vec3::Zero());
    EXPECT_TRUE(y[v].allFinite());
  }
  test::expect_diagonal_blocks_positive_semidefinite(energy, x);
}

TEST(SpringEnergy, MaxStretchIsTheLargestLengthOverRestLength) {
  const Lattice lattice = test::box_lattice({2, 1, 1});
  const SpringEnergy energy(build_springs(lattice, Bracing::kuhn), 1, flag_moduli);
  std::vector<Vec3> x = test::rest_positions(lattice);
  EXPECT_NEAR(energy.max_stretch(x), 1, 1e-12);
  for (Vec3& p : x) p.x() *= 1.5;
  EXPECT_NEAR(energy.max_stretch(x), 1.5, 1e-12);
}

class SpringDampingTest : public testing::Test {
 protected:
  const Lattice lattice_ = test::box_lattice({3, 2, 1});
  const std::vector<Vec3> rest_ = test::rest_positions(lattice_);
  const std::shared_ptr<const SpringEnergy> springs_ = std::make_shared<SpringEnergy>(
      build_springs(lattice_, Bracing::kuhn), 1, std::array<double, 3>{200, 30, 10});
  const SpringDamping damping_{springs_, 0.02};

  StepContext context(const std::vector<Vec3>& velocities, double dt) const {
    StepContext step;
    step.time_end = step.dt = dt;
    step.velocity_time = 0.5 * dt;
    step.anchor = rest_;
    step.positions = rest_;
    step.velocities = velocities;
    return step;
  }
};

TEST_F(SpringDampingTest, PassesTheBattery) {
  const std::vector<Vec3> velocities = test::random_vectors(rest_.size(), 1, 3);
  const auto potential = damping_.potential(context(velocities, 0.1));
  test::expect_potential_is_sound(*potential, crumpled(rest_, 0.2));
  test::expect_rest_state(*potential, rest_);
}

TEST_F(SpringDampingTest, ForceIsTheDashpotsOfTheRelativeVelocityAlongTheSpring) {
  std::vector<Vec3> velocities(rest_.size(), Vec3::Zero());
  const double dt = 0.01;
  const auto potential = damping_.potential(context(velocities, dt));
  // Only vertex 0 moves, at 1 m/s along x: its x edge (k 200) and its diagonals resist.
  std::vector<Vec3> x = rest_;
  x[0].x() += dt;
  double expected = 0;
  for (const auto& [k, n] : {std::pair<double, Vec3>{200, Vec3(1, 0, 0)},
                             {30, Vec3(1, 1, 0)},
                             {30, Vec3(1, 0, 1)},
                             {10, Vec3(1, 1, 1)}}) {
    expected += 0.02 * k * std::pow(n.normalized().x(), 2);
  }
  EXPECT_NEAR(test::gradient(*potential, x)[0].x(), expected, 1e-10);
}

TEST_F(SpringDampingTest, FreeFallAndRigidRotationAreNotDamped) {
  const double dt = 0.01;
  const Vec3 omega(0.2, -1.0, 2.0);
  std::vector<Vec3> falling(rest_.size(), Vec3(0, -3, 1));
  const auto free_fall = damping_.potential(context(falling, dt));
  EXPECT_LE(test::norm(test::gradient(*free_fall, test::sum(rest_, dt, falling))), 1e-12);

  std::vector<Vec3> turning;
  for (const Vec3& p : rest_) turning.push_back(omega.cross(p));
  std::vector<Vec3> turned;
  for (const Vec3& p : rest_) turned.push_back(Eigen::AngleAxisd(dt * omega.norm(), omega.normalized()) * p);
  const auto rotation = damping_.potential(context(turning, dt));
  // This speed along the springs would give forces of about β k |ω| = 9 N.
  EXPECT_LE(test::norm(test::gradient(*rotation, turned)), 1e-4);
}

}  // namespace
}  // namespace muslin
