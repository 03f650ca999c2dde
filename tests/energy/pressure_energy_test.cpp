// Pressure in closed and nearly closed surfaces: derivatives, closed forms of the volume and of the gas,
// blocks.
#include "muslin/energy/pressure_energy.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "support/ball_surface.hpp"
#include "support/linearized_product.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using test::ball;
using test::Surface;

std::shared_ptr<const EnclosedVolume> volume_of(const Surface& s) {
  return std::make_shared<const EnclosedVolume>(s.triangles, s.x.size());
}

constexpr Gas constant{3000, 0, 0};

Gas air(double rest_volume) { return {2000, 101325, rest_volume}; }

TEST(EnclosedVolume, IsTranslationInvariantAndExactForABall) {
  const double exact = 4 * std::numbers::pi / 3 * 0.001;
  EXPECT_NEAR(volume_of(ball(60, 0.1))->value(ball(60, 0.1).x) / exact, 1, 5e-3);
  const Surface here = ball(12, 0.1), far = ball(12, 0.1, false, Vec3(1000, -2000, 500));
  EXPECT_NEAR(volume_of(far)->value(far.x) / volume_of(here)->value(here.x), 1, 1e-9);
}

TEST(EnclosedVolume, HoleIsClosedByAFlatLid) {
  const Surface open = ball(60, 0.1, true);
  ASSERT_EQ(volume_of(open)->holes().size(), 1U);
  const double exact = 4 * std::numbers::pi / 3 * 0.001;
  EXPECT_NEAR(volume_of(open)->value(open.x) / exact, 1, 6e-3);
}

TEST(EnclosedVolume, RefusesInconsistentOrientation) {
  Surface s = ball(4, 1);
  std::swap(s.triangles[3][0], s.triangles[3][1]);
  EXPECT_THROW((void)volume_of(s), Error);
}

TEST(PressureEnergy, PassesTheBatteryClosedAndOpenConstantAndAsAGas) {
  for (const bool open : {false, true}) {
    const Surface s = ball(5, 0.1, open);
    const auto volume = volume_of(s);
    const double rest = volume->value(s.x);
    for (const Gas& gas : {constant, Gas{-500, 0, 0}, air(rest), air(3 * rest), air(200 * rest)}) {
      const PressureEnergy energy(volume, gas);
      const std::vector<Vec3> x = test::sum(s.x, 1, test::random_vectors(s.x.size(), 0.01, 5));
      test::expect_potential_is_sound(energy, x, 0.1);
      test::expect_rigid_motion_invariant(energy, x);
    }
  }
}

TEST(PressureEnergy, ForceOnAFaceIsPressureTimesArea) {
  // The forces on a ball's lower half add up to p π r² downwards.
  const double radius = 0.1, pressure = 3000;
  const Surface s = ball(60, radius);
  const std::vector<Vec3> g = test::gradient(PressureEnergy(volume_of(s), constant), s.x);
  Vec3 force = Vec3::Zero();
  for (std::size_t v = 0; v < g.size(); ++v)
    force -= (s.x[v].y() < -1e-9 ? 1 : s.x[v].y() < 1e-9 ? 0.5 : 0) * g[v];
  EXPECT_NEAR(force.y() / (-pressure * std::numbers::pi * radius * radius), 1, 5e-3);
}

TEST(PressureEnergy, GasFollowsBoyle) {
  const Gas gas = air(2.0);
  EXPECT_NEAR(gas.at(2).pressure, 2000, 1e-9);
  EXPECT_NEAR(gas.at(2).energy, 0, 1e-9);
  EXPECT_NEAR(gas.at(1).pressure + 101325, 2 * (101325 + 2000), 1e-6);
  EXPECT_NEAR(gas.at(4).pressure + 101325, 0.5 * (101325 + 2000), 1e-6);
  // W is the work of compression; p and its slope go on without a jump where the volume is all but gone.
  EXPECT_NEAR(gas.at(1).energy, 2 * 103325 * std::log(2.0) - 101325, 1e-6);
  for (const double v : {0.02, -0.5}) {
    const double d = 1e-7;
    EXPECT_NEAR((gas.at(v + d).energy - gas.at(v - d).energy) / (2 * d) / -gas.at(v).pressure, 1, 1e-5);
    EXPECT_TRUE(std::isfinite(gas.at(v).energy));
  }
}

TEST(PressureEnergy, BlocksArePositiveAndTheHessianWithoutItsNegativePart) {
  const Surface s = ball(6, 0.1, true);
  const double rest = volume_of(s)->value(s.x);
  for (const Gas& gas : {constant, air(rest)}) {
    const PressureEnergy energy(volume_of(s), gas);
    const std::vector<double> masses(s.x.size(), 1e-9);
    const std::vector<std::uint8_t> fixed(s.x.size(), 0);
    Linearization h;
    h.reset(masses, fixed, 0.5);
    energy.linearize(s.x, h, 0);
    h.finish();
    for (std::uint32_t seed = 1; seed < 20; ++seed) {
      const std::vector<Vec3> p = test::random_vectors(s.x.size(), 1, seed);
      const double work = test::inner(p, test::product(h, p));
      EXPECT_GE(work, 0);
      EXPECT_GE(work, 0.5 * test::inner(p, test::hessian_product(energy, s.x, p)) * (1 - 0.05));
    }
    if (gas.rest_volume == 0) continue;
    // A ball that grows evenly feels the gas alone: 81 p V in all, that is, −p' (3 V)².
    const double p = gas.at(rest).pressure, slope = gas.at(rest).slope;
    const double exact = test::inner(s.x, test::hessian_product(energy, s.x, s.x));
    EXPECT_NEAR(exact, -6 * p * rest - slope * 9 * rest * rest, 1e-9 * exact);
    EXPECT_GE(test::inner(s.x, test::product(h, s.x)), 0.5 * -slope * 9 * rest * rest * (1 - 1e-5));
  }
}

TEST(Pressure, FollowsItsKeyframesAndWindow) {
  const Surface s = ball(4, 0.1);
  const Pressure load(volume_of(s), [](double, double t) -> std::optional<Gas> {
    if (t == 0) return std::nullopt;
    return Gas{1000 * t, 0, 0};
  });
  StepContext step;
  step.time_end = 0;
  EXPECT_EQ(load.potential(step), nullptr);
  step.time_end = 2;
  EXPECT_NEAR(load.potential(step)->value(s.x), -2000 * volume_of(s)->value(s.x), 1e-12);
}

TEST(PressureEnergy, RefusesANegativeAmountOfGas) {
  const Surface s = ball(4, 0.1);
  EXPECT_THROW(PressureEnergy(volume_of(s), {-2e5, 1e5, 1}), Error);
  EXPECT_THROW(PressureEnergy(volume_of(s), {1e3, 1e5, -1}), Error);
  EXPECT_THROW(PressureEnergy(volume_of(s), {NAN, 0, 0}), Error);
}

}  // namespace
}  // namespace muslin
