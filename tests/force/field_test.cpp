// Fields: falloff, regions, patterns against closed forms, turbulence, drag in closed form, air that they
// move.
#include "muslin/force/field.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/force/curve_pattern.hpp"
#include "muslin/force/drag_field.hpp"
#include "muslin/force/field_force.hpp"
#include "muslin/force/gravity.hpp"
#include "muslin/force/grid_pattern.hpp"
#include "muslin/force/simple_patterns.hpp"
#include "muslin/force/turbulence.hpp"

namespace muslin {
namespace {

constexpr double pi = std::numbers::pi;
const Window whole_run{0, std::numeric_limits<double>::infinity()};

Field field_of(std::shared_ptr<const FieldPattern> pattern, double strength) {
  Field field;
  field.extent.strength = strength;
  field.extent.window = whole_run;
  field.pattern = std::move(pattern);
  return field;
}

StepContext step_of(ConstVectors x, ConstVectors v, double begin, double end) {
  StepContext context;
  context.time_begin = begin;
  context.time_end = end;
  context.dt = end - begin;
  context.anchor.assign(x.begin(), x.end());
  context.positions = x;
  context.velocities = v;
  return context;
}

TEST(Falloff, IsOneUpToMinThenAPowerAndZeroBeyondMax) {
  Falloff falloff;
  EXPECT_EQ(falloff.at(1e9), 1);
  falloff = {2, 0.5, std::nullopt, 3};
  EXPECT_EQ(falloff.at(0.5), 1);
  EXPECT_NEAR(falloff.at(1.5), 1.0 / 9, 1e-15);  // (r / min)^−2
  EXPECT_GT(falloff.at(3), 0);
  EXPECT_EQ(falloff.at(3.001), 0);
  falloff.length = 2;
  EXPECT_NEAR(falloff.at(2.5), 0.25, 1e-15);  // (1 + 2/2)^−2
  falloff = {1, 0, std::nullopt, std::nullopt};
  EXPECT_NEAR(falloff.at(3), 0.25, 1e-15);  // 1/(1 + r)
}

TEST(Region, IsWhereItsShapesOverlapAndFadesInside) {
  Region region;
  region.box = Region::BoxShape{Vec3(0, 0, 0), Vec3(2, 2, 2)};
  EXPECT_EQ(region.weight(Vec3(1, 1, 1)), 1);
  EXPECT_EQ(region.weight(Vec3(2, 0, 1)), 1);
  EXPECT_EQ(region.weight(Vec3(2.01, 1, 1)), 0);
  region.fade = 0.5;
  EXPECT_EQ(region.weight(Vec3(1, 1, 0)), 0);
  EXPECT_EQ(region.weight(Vec3(1, 1, 0.25)), 0.5);
  EXPECT_EQ(region.weight(Vec3(1, 1, 0.5)), 1);
  region.sphere = Region::SphereShape{Vec3(0, 0, 0), 1};
  EXPECT_EQ(region.weight(Vec3(1, 1, 1)), 0);
  EXPECT_EQ(region.weight(Vec3(0.5, 0.75, 0.75)), 0);
  EXPECT_GT(region.weight(Vec3(0.5, 0.5, 0.5)), 0);

  Region others;
  others.cylinder = Region::CylinderShape{Vec3(0, 0, 0), Vec3(0, 3, 0), 0.5};
  EXPECT_EQ(others.weight(Vec3(0.3, 1, 0.3)), 1);
  EXPECT_EQ(others.weight(Vec3(0.4, 1, 0.4)), 0);
  EXPECT_EQ(others.weight(Vec3(0, 3.1, 0)), 0);
  others.plane = Region::PlaneShape{Vec3(0, 2, 0), Vec3(0, 1, 0)};
  EXPECT_EQ(others.weight(Vec3(0.3, 1, 0.3)), 0);
  EXPECT_EQ(others.weight(Vec3(0.3, 2.5, 0.3)), 1);
}

/// ∮ u·dx around a circle about an axis through the origin.
double circulation(const Field& field, double radius) {
  double sum = 0;
  const int n = 200;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * pi * (i + 0.5) / n;
    const Vec3 along(-std::sin(angle), std::cos(angle), 0);
    sum += field.at(radius * Vec3(std::cos(angle), std::sin(angle), 0.3), 0).dot(along) * 2 * pi * radius / n;
  }
  return sum;
}

TEST(Fields, VortexOfRankineHasItsCirculationOutsideAndTurnsLikeASolidInside) {
  Field vortex = field_of(std::make_shared<VortexPattern>(Vec3::UnitZ(), 0.2), 1);
  vortex.extent.falloff.power = 2;
  vortex.extent.falloff.min = 0.2;
  const double expected = 2 * pi * 0.2;
  for (const double r : {0.2, 0.5, 7.0}) EXPECT_NEAR(circulation(vortex, r), expected, 1e-12) << r;
  EXPECT_NEAR(circulation(vortex, 0.1), expected / 4, 1e-12);  // with the enclosed area
  EXPECT_EQ(vortex.at(Vec3(0, 0, 5), 0), Vec3::Zero());
}

TEST(Fields, RadialPointsAwayFromItsCentreAndFallsOff) {
  Field radial = field_of(std::make_shared<RadialPattern>(), 1);
  radial.extent.center = Vec3(1, 0, 0);
  radial.extent.falloff = {2, 1, std::nullopt, std::nullopt};
  EXPECT_LT((radial.at(Vec3(1, 3, 0), 0) - Vec3(0, 1.0 / 9, 0)).norm(), 1e-15);
  EXPECT_EQ(radial.at(Vec3(1, 0, 0), 0), Vec3::Zero());
}

TEST(Fields, CurveGuidesAlongItsTangentAndAttracts) {
  const Field curve = field_of(
      std::make_shared<CurvePattern>(CurvePattern::Settings{{Vec3(0, 0, 0), Vec3(4, 0, 0)}, 0.5, 0.2}), 1);
  EXPECT_LT((curve.at(Vec3(1, 0, 0), 0) - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((curve.at(Vec3(1, 1, 0), 0) - Vec3(1, -0.5, 0)).norm(), 1e-15);
  EXPECT_LT((curve.at(Vec3(1, 0, 0.1), 0) - Vec3(1, 0, -0.25)).norm(), 1e-15);  // half the reach
  EXPECT_LT((curve.at(Vec3(6, 0, 0), 0) - Vec3(0.5, 0, 0)).norm(), 1e-15);      // beyond the end

  const Field corner = field_of(std::make_shared<CurvePattern>(CurvePattern::Settings{
                                    {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)}, 0, 0.1}),
                                1);
  const Vec3 before = corner.at(Vec3(1 - 1e-9, 0, 0), 0), after = corner.at(Vec3(1, 1e-9, 0), 0);
  EXPECT_LT((before - after).norm(), 1e-8);
  EXPECT_LT((after - Vec3(1, 1, 0).normalized()).norm(), 1e-8);
}

TEST(Fields, GridReproducesALinearFieldAndIsZeroOutside) {
  const Vec3 origin(-1, 0.5, 2), spacing(0.5, 0.25, 1);
  const auto linear = [](const Vec3& x) {
    return Vec3(1 + 2 * x.x() - x.z(), 3 * x.y(), x.x() - x.y() + 4 * x.z());
  };
  VectorGrid grid{{5, 3, 4}, {}};
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 4; ++k)
        grid.vectors.push_back(linear(origin + Vec3(i, j, k).cwiseProduct(spacing)));
  const GridPattern pattern(grid, origin, spacing);
  for (const Vec3& r : test::random_vectors(200, 1, 5)) {
    const Vec3 x = origin + 0.5 * (r + Vec3::Ones()).cwiseProduct(Vec3(2, 0.5, 3));
    EXPECT_LT((pattern.at(x, 0).vector - linear(x)).norm(), 1e-13);
  }
  const Vec3 far = origin + Vec3(2, 0.5, 3);
  EXPECT_LT((pattern.at(far, 0).vector - linear(far)).norm(), 1e-13);
  EXPECT_EQ(pattern.at(far + Vec3(0, 1e-9, 0), 0).vector, Vec3::Zero());
  EXPECT_EQ(pattern.at(origin - Vec3(1e-9, 0, 0), 0).vector, Vec3::Zero());
}

TEST(Fields, TravelCarriesThePatternAndLeavesTheRegion) {
  Turbulence::Settings settings;
  settings.seed = 5;
  Field gusts = field_of(std::make_shared<Turbulence>(settings), 1);
  gusts.extent.travel = Vec3(3, 0, -1);
  for (const Vec3& x : test::random_vectors(50, 2, 3)) {
    const double t = 1.7;
    EXPECT_LT((gusts.at(x, t) - gusts.at(x - t * gusts.extent.travel, 0)).norm(), 1e-12);
  }
  gusts.extent.region.emplace().sphere = Region::SphereShape{Vec3::Zero(), 1};
  EXPECT_GT(gusts.at(Vec3(0.5, 0, 0), 10).norm(), 0);
  EXPECT_EQ(gusts.at(Vec3(30, 0, -10), 10), Vec3::Zero());
}

TEST(Turbulence, HasNoDivergence) {
  const Turbulence turbulence({2, 0.25, 1, 3});
  const double h = 1e-4;
  for (const Vec3& x : test::random_vectors(100, 5, 9)) {
    double divergence = 0, gradient = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 slope = (turbulence.at(x + h * Vec3::Unit(axis), 0.4).vector -
                          turbulence.at(x - h * Vec3::Unit(axis), 0.4).vector) /
                         (2 * h);
      divergence += slope[axis];
      gradient += slope.squaredNorm();
    }
    EXPECT_LT(std::abs(divergence), 1e-6 * std::sqrt(gradient));
  }
}

TEST(Turbulence, HasUnitRootMeanSquareInEveryComponentAndNoCorrelation) {
  const Turbulence turbulence({1, 0.1, std::numeric_limits<double>::infinity(), 1});
  // Exactly, as a mean over all space: the sum of ½ a aᵀ over the waves.
  Mat3 covariance = Mat3::Zero();
  for (const Turbulence::Wave& wave : turbulence.waves()) {
    covariance += 0.5 * wave.amplitude * wave.amplitude.transpose();
    EXPECT_NEAR(wave.amplitude.dot(wave.number), 0, 1e-12);
  }
  EXPECT_LT((covariance - Mat3::Identity()).norm(), 1e-12);
  // And measured at random places.
  Mat3 measured = Mat3::Zero();
  const std::vector<Vec3> places = test::random_vectors(40000, 1000, 8);
  for (const Vec3& x : places) {
    const Vec3 u = turbulence.at(x, 0).vector;
    measured += u * u.transpose() / static_cast<double>(places.size());
  }
  EXPECT_LT((measured - Mat3::Identity()).norm(), 0.05);
}

TEST(Turbulence, HasKolmogorovsSpectrumBetweenItsEddies) {
  const double largest = 4, smallest = 0.5;
  const Turbulence turbulence({largest, smallest, std::numeric_limits<double>::infinity(), 7});
  // The energy in waves up to k over that of all is that of ∫ k^−5/3 dk.
  const auto primitive = [](double k) { return -std::pow(k, -2.0 / 3); };
  const double lower = 2 * pi / largest, upper = 2 * pi / smallest;
  for (const double k : {lower * std::pow(2, 0.5), lower * 2, lower * 4, upper}) {
    double energy = 0;
    for (const Turbulence::Wave& wave : turbulence.waves()) {
      EXPECT_GE(wave.number.norm(), lower);
      EXPECT_LE(wave.number.norm(), upper);
      if (wave.number.norm() < k) energy += wave.amplitude.squaredNorm() / 4;
    }
    const double share = (primitive(k) - primitive(lower)) / (primitive(upper) - primitive(lower));
    EXPECT_NEAR(energy / 1.5, share, 1e-12) << k;
  }
}

TEST(Turbulence, IsDecidedByItsSeedAndFrozenWithoutATurnover) {
  const Turbulence::Settings frozen{1, 0.2, std::numeric_limits<double>::infinity(), 1};
  Turbulence::Settings changing = frozen, other = frozen;
  changing.turnover = 1;
  other.seed = 2;
  const Vec3 x(0.3, 0.1, -0.2);
  EXPECT_EQ(Turbulence(frozen).at(x, 0).vector, Turbulence(frozen).at(x, 5).vector);
  EXPECT_EQ(Turbulence(frozen).at(x, 0).vector, Turbulence(changing).at(x, 0).vector);
  EXPECT_GT((Turbulence(changing).at(x, 0.3).vector - Turbulence(frozen).at(x, 0).vector).norm(), 1e-2);
  EXPECT_GT((Turbulence(other).at(x, 0).vector - Turbulence(frozen).at(x, 0).vector).norm(), 1e-2);
}

TEST(FieldForce, UniformIsGravity) {
  const std::vector<Vec3> x = test::random_vectors(500, 2, 4);
  const std::vector<double> masses(500, 0.3);
  const Gravity gravity(masses, Keyed{{{0, Vec3(0, -9.8, 0)}}}, whole_run);
  const FieldForce field(masses, field_of(std::make_shared<UniformPattern>(-Vec3::UnitY()), 9.8));
  const StepContext context = step_of(x, x, 0, 0.1);
  const auto pull = gravity.potential(context), push = field.potential(context);
  EXPECT_EQ(test::gradient(*pull, x), test::gradient(*push, x));
  test::expect_potential_is_sound(*push, x);
}

TEST(FieldForce, FollowsItsKeysItsWindowAndItsMasses) {
  Field field = field_of(std::make_shared<UniformPattern>(Vec3::UnitX()), 0);
  field.extent.strength.keys = {{0, 0}, {1, 8}};
  field.extent.window = {0.25, 2};
  const std::vector<Vec3> x(2, Vec3::Zero());
  const FieldForce force({2, 0}, field);
  const auto push = [&](double begin, double end) {
    const auto potential = force.potential(step_of(x, x, begin, end));
    return potential ? -test::gradient(*potential, x)[0].x() : 0.0;
  };
  EXPECT_EQ(push(0, 0.25), 0);
  EXPECT_EQ(push(0.25, 0.5), 8);
  EXPECT_EQ(push(0, 0.5), 4);  // acts during half the step
  EXPECT_EQ(push(2, 2.5), 0);
  EXPECT_EQ(test::gradient(*force.potential(step_of(x, x, 1, 1.5)), x)[1], Vec3::Zero());
}

TEST(FieldForce, HasTheSameBitsForAnyThreadCount) {
  const std::vector<Vec3> x = test::random_vectors(6000, 2, 4);
  const FieldForce field(std::vector<double>(6000, 0.3),
                         field_of(std::make_shared<Turbulence>(Turbulence::Settings{}), 3));
  const auto gradient = [&](int threads) {
    set_thread_count(threads);
    return test::gradient(*field.potential(step_of(x, x, 0, 0.1)), x);
  };
  const int before = thread_count();
  const std::vector<Vec3> one = gradient(1), three = gradient(3);
  set_thread_count(before);
  EXPECT_EQ(one, three);
}

/// The speed of a point of 2 kg after steps of implicit Euler in the drag.
double slowed(const DragField& drag, double speed, double dt, int steps) {
  const double mass = 2;
  std::vector<Vec3> x = {Vec3::Zero()}, v = {Vec3(speed, 0, 0)};
  for (int i = 0; i < steps; ++i) {
    const auto potential = drag.potential(step_of(x, v, i * dt, (i + 1) * dt));
    const double slope = test::hessian_product(*potential, x, std::vector<Vec3>{Vec3::UnitX()})[0].x();
    v[0] /= 1 + slope * dt * dt / mass;  // m (v₁ − v₀)/dt = −slope dt v₁
    x[0] += dt * v[0];
  }
  return v[0].x();
}

FieldExtent everywhere() {
  FieldExtent extent;
  extent.window = whole_run;
  return extent;
}

TEST(DragField, LinearDragDecaysExponentially) {
  const DragField drag({2}, everywhere(), {1.5, 0});
  EXPECT_NEAR(slowed(drag, 3, 1e-4, 10000), 3 * std::exp(-1.5), 2e-4 * 3 * std::exp(-1.5));
  EXPECT_NEAR(slowed(drag, 3, 0.1, 1), 3 / 1.15, 1e-14);
}

TEST(DragField, QuadraticDragDecaysHyperbolically) {
  const DragField drag({2}, everywhere(), {0, 0.7});
  EXPECT_NEAR(slowed(drag, 5, 1e-4, 10000), 5 / (1 + 0.7 * 5 * 1), 1e-3);
  // The map 1/v₁ = 1/v₀ + k dt is that of the closed form at any step.
  EXPECT_NEAR(slowed(drag, 5, 10, 20), 5 / (1 + 0.7 * 5 * 200), 1e-12);
}

TEST(DragField, ActsByRegionFalloffAndStrengthAndNeverReversesAMotion) {
  FieldExtent extent = everywhere();
  extent.region.emplace().sphere = Region::SphereShape{Vec3(1, 0, 0), 2};
  extent.falloff = {1, 0, 1, std::nullopt};
  extent.strength = 4;
  const std::vector<Vec3> x = {Vec3(0, 1, 0), Vec3(-1.5, 0, 0)}, v(2, Vec3(0, 2, 0));
  const DragField drag({1, 1}, extent, {3, 0.5});
  const auto potential = drag.potential(step_of(x, v, 0, 0.01));
  const std::vector<Vec3> g =
      test::gradient(*potential, std::vector<Vec3>{x[0] + 0.01 * v[0], x[1] + 0.01 * v[1]});
  EXPECT_LT((g[0] - Vec3(0, 4 * 0.5 * (3 + 0.5 * 2) * 2, 0)).norm(), 1e-12);
  EXPECT_EQ(g[1], Vec3::Zero());
  test::expect_potential_is_sound(*potential, x);
  const DragField violent({2}, everywhere(), {1e6, 1e6});
  const double left = slowed(violent, 1e4, 1000, 3);
  EXPECT_GE(left, 0);
  EXPECT_LT(left, 1e-9);
}

}  // namespace
}  // namespace muslin
