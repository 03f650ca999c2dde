// Pressures that differ from vertex to vertex push as Gauss's theorem says.
#include "muslin/force/uneven_pressure.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include "support/ball_surface.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/energy/pressure_energy.hpp"

namespace muslin {
namespace {

Vec3 total(const std::vector<Vec3>& forces) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& f : forces) sum += f;
  return sum;
}

TEST(UnevenPressure, ThatIsLinearPushesWithItsGradientTimesTheVolume) {
  for (const bool open : {false, true}) {
    const test::Surface s = test::ball(12, 0.1, open, Vec3(0.4, -0.2, 0.1));
    const auto surface = std::make_shared<const EnclosedVolume>(s.triangles, s.x.size());
    const Vec3 gradient(3, -1, 2);
    std::vector<double> shares;
    shares.reserve(s.x.size());
    for (const Vec3& x : s.x) shares.push_back(0.5 + gradient.dot(x));
    const UnevenPressure load(surface, shares, [](double, double) { return 100.0; });
    // ∮ p n dA = ∫ ∇p dV, and p is linear on every triangle.
    const Vec3 expected = 100 * surface->value(s.x) * gradient;
    EXPECT_LT((total(load.forces(s.x, 100)) - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST(UnevenPressure, ThatIsEvenPushesAsTheEnergyDoes) {
  const test::Surface s = test::ball(6, 0.1, true);
  const auto surface = std::make_shared<const EnclosedVolume>(s.triangles, s.x.size());
  const UnevenPressure load(surface, std::vector<double>(s.x.size(), 0.5),
                            [](double, double) { return 60.0; });
  std::vector<Vec3> gradient(s.x.size(), Vec3::Zero());
  PressureEnergy(surface, {30, 0, 0}).add_gradient(s.x, gradient);
  const std::vector<Vec3> forces = load.forces(s.x, 60);
  for (std::size_t v = 0; v < forces.size(); ++v) EXPECT_LT((forces[v] + gradient[v]).norm(), 1e-14);
}

TEST(UnevenPressure, ActsOnlyWhileItIsNotZeroAndOnAllVertices) {
  const test::Surface s = test::ball(4, 0.1);
  const auto surface = std::make_shared<const EnclosedVolume>(s.triangles, s.x.size());
  const UnevenPressure load(surface, std::vector<double>(s.x.size(), 1),
                            [](double begin, double) { return begin < 1 ? 5.0 : 0.0; });
  StepContext step;
  step.positions = s.x;
  step.time_begin = 0.5;
  const auto potential = load.potential(step);
  ASSERT_NE(potential, nullptr);
  std::vector<Vec3> gradient(s.x.size(), Vec3::Zero());
  potential->add_gradient(s.x, gradient);
  EXPECT_EQ(gradient.front(), Vec3(-load.forces(s.x, 5).front()));
  step.time_begin = 1;
  EXPECT_EQ(load.potential(step), nullptr);
  EXPECT_THROW(UnevenPressure(surface, {1}, [](double, double) { return 1.0; }), Error);
}

}  // namespace
}  // namespace muslin
