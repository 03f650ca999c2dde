// The potentials that need no lattice, and the range wrapper.
#include <memory>

#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/potential/mass_damping.hpp"
#include "muslin/potential/restricted.hpp"

namespace muslin {
namespace {

StepContext step_at_rest(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double dt) {
  StepContext step;
  step.time_end = step.dt = dt;
  step.anchor = x;
  step.positions = x;
  step.velocities = v;
  return step;
}

TEST(MassDamping, IsMinusAlphaTimesMomentum) {
  const std::vector<Vec3> x = test::random_vectors(5, 1, 1);
  const std::vector<Vec3> v = test::random_vectors(5, 1, 2);
  const MassDamping damping(0.3, {1, 2, 3, 4, 5});
  const auto potential = damping.potential(step_at_rest(x, v, 0.1));
  test::expect_potential_is_sound(*potential, test::random_vectors(5, 1, 3));
  const std::vector<Vec3> g = test::gradient(*potential, test::sum(x, 0.1, v));
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_LE((g[i] - 0.3 * static_cast<double>(i + 1) * v[i]).norm(), 1e-13);
  }
  EXPECT_EQ(MassDamping(0, {1, 1, 1, 1, 1}).potential(step_at_rest(x, v, 0.1)), nullptr);
}

TEST(Restricted, ActsOnItsRangeOnly) {
  const std::vector<Vec3> x = test::random_vectors(7, 1, 1);
  const std::vector<Vec3> v = test::random_vectors(7, 1, 2);
  const RestrictedLoad load(std::make_shared<MassDamping>(0.5, std::vector<double>{1, 2, 3}), 2, 3);
  const auto potential = load.potential(step_at_rest(x, v, 0.1));
  const std::vector<Vec3> y = test::random_vectors(7, 1, 3);
  test::expect_potential_is_sound(*potential, y);
  const std::vector<Vec3> g = test::gradient(*potential, y);
  for (const std::size_t i : {0, 1, 5, 6}) EXPECT_EQ(g[i], Vec3::Zero());
  EXPECT_LE((g[3] - 0.5 * 2 / 0.1 * (y[3] - x[3])).norm(), 1e-12);
}

}  // namespace
}  // namespace muslin
