// Wind: drag and lift by hand, terminal velocity in closed form, stability at any step, closed solids, gusts.
#include "muslin/force/wind.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/force/gusts.hpp"
#include "muslin/force/simple_patterns.hpp"
#include "muslin/force/turbulence.hpp"

namespace muslin {
namespace {

constexpr double pi = std::numbers::pi;
const Window always{0, std::numeric_limits<double>::infinity()};

Keyed constant(const Vec3& v) { return Keyed{{{0, v}}}; }

/// Points that are the vertices themselves.
Embedding identity(std::size_t count) {
  Embedding skin;
  for (std::size_t v = 0; v < count; ++v) {
    std::array<int, 8> vertices;
    vertices.fill(static_cast<int>(v));
    skin.vertices.push_back(vertices);
    skin.weights.push_back({1, 0, 0, 0, 0, 0, 0, 0});
  }
  return skin;
}

/// A square of side 1 in the xz plane, normal along y, turned by `angle` about z.
std::vector<Vec3> plate(double angle) {
  const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  std::vector<Vec3> x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 1), Vec3(0, 0, 1)};
  for (Vec3& p : x) p = turn * p;
  return x;
}
const std::vector<Vec3i> plate_triangles = {Vec3i(0, 2, 1), Vec3i(0, 3, 2)};

struct Moving {
  std::vector<Vec3> x, v;
  double time = 0;

  StepContext step(double dt) const {
    StepContext context;
    context.time_begin = time;
    context.time_end = time + dt;
    context.dt = dt;
    context.anchor = x;
    context.positions = x;
    context.velocities = v;
    return context;
  }
};
Moving resting(const std::vector<Vec3>& x) { return {x, std::vector<Vec3>(x.size(), Vec3::Zero())}; }

/// The total force when the body ends the step where it began.
Vec3 force(const WindSettings& settings, const Moving& body, const std::vector<Vec3i>& triangles,
           double dt = 0.01) {
  const Wind wind(settings, identity(body.x.size()), triangles, body.x.size());
  const auto potential = wind.potential(body.step(dt));
  Vec3 sum = Vec3::Zero();
  if (potential)
    for (const Vec3& g : test::gradient(*potential, body.x)) sum -= g;
  return sum;
}

WindSettings blowing(const Vec3& velocity) {
  WindSettings settings;
  settings.velocity = constant(velocity);
  settings.window = always;
  return settings;
}

TEST(Wind, DragIsThatOfTheProjectedAreaAtEveryAngle) {
  WindSettings settings = blowing(Vec3(0, 7, 0));
  for (const double degrees : {0.0, 20.0, 45.0, 70.0, 90.0, 135.0}) {
    const double alpha = degrees * pi / 180;
    const double expected = 0.5 * 1.17 * 1.2 * 49 * std::abs(std::cos(alpha));
    const Vec3 f = force(settings, resting(plate(alpha)), plate_triangles);
    EXPECT_LT((f - Vec3(0, expected, 0)).norm(), 1e-12) << degrees;
  }
}

TEST(Wind, LiftIsAcrossTheWindAndVanishesSquareOnAndEdgeOn) {
  WindSettings settings = blowing(Vec3(0, 7, 0));
  settings.lift = 0.8;
  for (const double degrees : {0.0, 20.0, 45.0, 70.0, 90.0, 135.0}) {
    const double alpha = degrees * pi / 180;
    const Vec3 f = force(settings, resting(plate(alpha)), plate_triangles);
    const Vec3 n(-std::sin(alpha), std::cos(alpha), 0);
    const double q = 0.5 * 1.2 * 49;
    EXPECT_NEAR(f.y(), q * 1.17 * std::abs(n.y()), 1e-12) << degrees;  // drag
    EXPECT_NEAR(f.x(), q * 0.8 * n.y() * n.x(), 1e-12) << degrees;     // lift
    EXPECT_NEAR(f.z(), 0, 1e-12);
  }
}

TEST(Wind, OnlyRelativeVelocityCounts) {
  const Vec3 drift(3, -2, 1);
  Moving still = resting(plate(0.4));
  Moving moving = still;
  for (Vec3& v : moving.v) v = drift;
  const double dt = 0.01;
  const WindSettings settings = blowing(Vec3(1, 5, -1));
  const WindSettings shifted = blowing(Vec3(1, 5, -1) + drift);
  const Wind a(settings, identity(4), plate_triangles, 4), b(shifted, identity(4), plate_triangles, 4);
  const std::vector<Vec3> ga = test::gradient(*a.potential(still.step(dt)), still.x);
  const std::vector<Vec3> gb =
      test::gradient(*b.potential(moving.step(dt)), test::sum(moving.x, dt, moving.v));
  EXPECT_LT(test::norm(test::sum(ga, -1, gb)), 1e-12);
}

TEST(Wind, PassesTheBattery) {
  // Three plates that share carrying vertices through trilinear weights, each with its own attitude.
  std::vector<Vec3> x = test::random_vectors(8, 1, 3);
  Embedding skin;
  const std::vector<Vec3> mix = test::random_vectors(12, 0.5, 4);
  for (const Vec3& m : mix) {
    const Vec3 t = m + Vec3::Constant(0.5);
    std::array<double, 8> w;
    for (int c = 0; c < 8; ++c)
      w[static_cast<std::size_t>(c)] =
          (c & 1 ? t.x() : 1 - t.x()) * (c & 2 ? t.y() : 1 - t.y()) * (c & 4 ? t.z() : 1 - t.z());
    skin.vertices.push_back({0, 1, 2, 3, 4, 5, 6, 7});
    skin.weights.push_back(w);
  }
  WindSettings settings = blowing(Vec3(4, -3, 2));
  settings.lift = 1.17;
  settings.gust = 2;
  const Wind wind(settings, skin, {Vec3i(0, 1, 2), Vec3i(3, 4, 5), Vec3i(6, 7, 8), Vec3i(9, 10, 11)}, 8);
  const Moving body{x, test::random_vectors(8, 2, 6)};
  test::expect_potential_is_sound(*wind.potential(body.step(0.02)), test::sum(x, 0.02, body.v));
}

TEST(Wind, LargeSkinHasTheSameBitsForAnyThreadCount) {
  std::vector<Vec3> x = test::random_vectors(6000, 1, 3);
  std::vector<Vec3i> triangles;
  for (int i = 0; i < 9000; ++i) triangles.emplace_back(i % 6000, (7 * i + 1) % 6000, (11 * i + 2) % 6000);
  WindSettings settings = blowing(Vec3(4, -3, 2));
  settings.gust = 1;
  const Wind wind(settings, identity(6000), triangles, 6000);
  const Moving body{x, test::random_vectors(6000, 2, 6)};
  test::expect_same_bits_for_any_thread_count(*wind.potential(body.step(0.02)), x);
}

/// One implicit Euler step of a rigid body that only translates: mass (v₁ − v₀)/dt = weight + wind. Only
/// velocities change: the air is the same everywhere, and far from the origin digits would be lost.
void fall(Moving& body, const Wind& wind, double mass, double g, double dt) {
  const auto potential = wind.potential(body.step(dt));
  const auto total = [&](const Vec3& shift) {
    std::vector<Vec3> x = body.x;
    for (Vec3& p : x) p += shift;
    Vec3 sum = Vec3::Zero();
    for (const Vec3& f : test::gradient(*potential, x)) sum += f;
    return sum;
  };
  // The energy is quadratic, so one Newton step along y is exact.
  const double g0 = total(Vec3::Zero()).y();
  const double slope = total(Vec3::UnitY()).y() - g0;
  const double v = (mass * body.v[0].y() / dt - mass * g - g0) / (mass / dt + slope * dt);
  for (Vec3& velocity : body.v) velocity = Vec3(0, v, 0);
  body.time += dt;
}

TEST(Wind, SheetFallsBroadsideWithTheClosedForm) {
  // σ = 0.15 kg/m², C_D = 1.17, ρ = 1.2 kg/m³: v_t = √(2σg/(ρ C_D)) = 1.45 m/s.
  const double sigma = 0.15, g = 9.81;
  const double terminal = std::sqrt(2 * sigma * g / (1.2 * 1.17));
  EXPECT_NEAR(terminal, 1.45, 0.005);
  const Wind air(blowing(Vec3::Zero()), identity(4), plate_triangles, 4);
  const double dt = 1e-4;
  Moving sheet = resting(plate(0));
  double worst = 0;
  for (int i = 1; i <= 6000; ++i) {
    fall(sheet, air, sigma, g, dt);
    const double exact = terminal * std::tanh(g * i * dt / terminal);
    worst = std::max(worst, std::abs(-sheet.v[0].y() - exact));
  }
  EXPECT_LT(worst, 1e-3 * terminal);
  for (int i = 0; i < 3000; ++i) fall(sheet, air, sigma, g, 1e-3);
  EXPECT_NEAR(-sheet.v[0].y() / terminal, 1, 1e-9);
}

TEST(Wind, StableAtAnyStepAndAnyWind) {
  for (const double dt : {1.0 / 24, 1.0, 1000.0}) {
    for (const double speed : {0.0, 10.0, 1e4}) {
      WindSettings settings = blowing(Vec3(0, speed, 0));
      settings.lift = 1.17;
      const Wind wind(settings, identity(4), plate_triangles, 4);
      Moving sheet = resting(plate(0));
      const double terminal = std::sqrt(2 * 0.15 * 9.81 / (1.2 * 1.17));
      // Errors shrink by |1−a|/(1+a) a step, a = ½ ρ C_D v_t dt / σ.
      const double a = 9.81 * dt / terminal;
      const int steps = static_cast<int>(std::min(40.0 * std::max(a, 1 / a), 4e5)) + 100;
      for (int i = 0; i < steps; ++i) {
        fall(sheet, wind, 0.15, 9.81, dt);
        ASSERT_TRUE(std::isfinite(sheet.v[0].y()));
        ASSERT_LE(std::abs(sheet.v[0].y()), 2 * speed + terminal + 9.81 * dt);
      }
      EXPECT_NEAR((speed - sheet.v[0].y()) / terminal, 1, 1e-3) << dt << " " << speed;
    }
  }
}

TEST(Wind, ClosedSolidTakesPressureOnItsFrontalAreaOnly) {
  // A box of 1 × 2 × 3 m with outward faces.
  std::vector<Vec3> x;
  for (int c = 0; c < 8; ++c) x.emplace_back(c & 1, 2 * (c >> 1 & 1), 3 * (c >> 2 & 1));
  const std::vector<Vec3i> triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                        {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const Vec3 v(2, -3, 5);
  WindSettings settings = blowing(v);
  settings.two_sided = false;
  const double frontal = (6 * 2 + 3 * 3 + 2 * 5) / v.norm();  // Σ A |n·v̂| over three faces
  const Vec3 expected = 0.5 * 1.17 * 1.2 * v.norm() * frontal * v;
  EXPECT_LT((force(settings, resting(x), triangles) - expected).norm(), 1e-12);
  settings.two_sided = true;
  EXPECT_LT((force(settings, resting(x), triangles) - 2 * expected).norm(), 1e-12);
}

TEST(Wind, ActsOnlyInItsWindowAndFollowsItsKeys) {
  WindSettings settings = blowing(Vec3::Zero());
  settings.velocity = Keyed{{{0, Vec3(0, 0, 0)}, {2, Vec3(0, 8, 0)}}};
  settings.window = {0.5, 1};
  Moving body = resting(plate(0));
  const auto at = [&](double begin, double end) {
    body.time = begin;
    return force(settings, body, plate_triangles, end - begin).y();
  };
  EXPECT_EQ(at(0.25, 0.5), 0);
  EXPECT_NEAR(at(0.5, 0.75), 0.5 * 1.17 * 1.2 * 9, 1e-12);            // 3 m/s at the end of the step
  EXPECT_NEAR(at(0.875, 1.125), 0.5 * 0.5 * 1.17 * 1.2 * 16, 1e-12);  // half the step, 4 m/s
  EXPECT_EQ(at(1, 1.25), 0);
}

TEST(Wind, DragDensityAndGustsFollowTheirKeys) {
  const auto over_time = [](double first, double last) {
    KeyedNumber number;
    number.keys = {{0, first, Interpolation::smooth}, {2, last}};
    return number;
  };
  const auto at_half = [](const WindSettings& settings) {
    Moving body = resting(plate(0));
    body.time = 0.75;
    return force(settings, body, plate_triangles, 0.25);
  };
  WindSettings keyed = blowing(Vec3(1, 6, 0)), constant = keyed;
  keyed.drag = over_time(1, 3), constant.drag = 2;
  keyed.lift = over_time(0.5, 1), constant.lift = 0.75;
  keyed.air_density = over_time(0, 2), constant.air_density = 1;
  EXPECT_LT((at_half(keyed) - at_half(constant)).norm(), 1e-13 * at_half(constant).norm());
  // Eddies turn over by the integral of their speed.
  keyed.gust = over_time(2, 0), constant.gust = 1;
  KeyedNumber& gust = constant.gust;
  gust.keys = {{0, keyed.gust.integral(1), Interpolation::step}, {1, 1}};
  EXPECT_NEAR(gust.integral(1), keyed.gust.integral(1), 1e-15);
  EXPECT_LT((at_half(keyed) - at_half(constant)).norm(), 1e-12 * at_half(constant).norm());
}

TEST(Wind, DegenerateFacesAndStillAirExertNoForce) {
  EXPECT_EQ(force(blowing(Vec3(0, 7, 0)), resting(plate(0)), {Vec3i(0, 1, 1), Vec3i(2, 2, 2)}), Vec3::Zero());
  EXPECT_EQ(force(blowing(Vec3::Zero()), resting(plate(0)), plate_triangles), Vec3::Zero());
}

TEST(Wind, RejectsSettingsOutOfRange) {
  const auto message = [](auto change) -> std::string {
    WindSettings settings = blowing(Vec3::Zero());
    change(settings);
    try {
      Wind(settings, identity(4), plate_triangles, 4);
    } catch (const Error& e) {
      return e.what();
    }
    return "accepted";
  };
  const double nan = std::nan("");
  EXPECT_EQ(message([](WindSettings&) {}), "accepted");
  EXPECT_NE(message([](WindSettings& s) { s.lift = 2; }).find("lift"), std::string::npos);
  EXPECT_NE(message([](WindSettings& s) { s.drag = -1; }).find("drag"), std::string::npos);
  EXPECT_NE(message([=](WindSettings& s) { s.air_density = nan; }).find("air_density"), std::string::npos);
  EXPECT_NE(message([](WindSettings& s) { s.porosity = 1.5; }).find("porosity"), std::string::npos);
  EXPECT_NE(message([](WindSettings& s) { s.gust = -1; }).find("gust"), std::string::npos);
  EXPECT_NE(message([](WindSettings& s) { s.gust_length = 0; }).find("gust_length"), std::string::npos);
}

TEST(Gusts, HaveMeanZeroAndUnitRootMeanSquare) {
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  double product = 0;
  const int n = 200000;
  const std::vector<Vec3> places = test::random_vectors(n, 500, 8);
  for (int i = 0; i < n; ++i) {
    const Vec3 u = gust_noise(places[static_cast<std::size_t>(i)], 0.37 * i, 1);
    sum += u;
    squares += u.cwiseProduct(u);
    product += u.x() * u.y();
  }
  EXPECT_LT((sum / n).norm(), 0.02);
  EXPECT_LT(((squares / n).cwiseSqrt() - Vec3::Ones()).norm(), 0.02);
  EXPECT_NEAR(product / n, 0, 0.02);
}

TEST(Gusts, AreSmoothAcrossCellsAndDecidedByTheSeed) {
  for (const double at : {0.0, 0.5, 3.0, -2.0, 7.25}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p(0.3, -1.7, 2.2);
      p[axis] = at;
      const double h = 1e-4;
      const Vec3 back = (gust_noise(p, 0.4, 1) - gust_noise(p - h * Vec3::Unit(axis), 0.4, 1)) / h;
      const Vec3 forth = (gust_noise(p + h * Vec3::Unit(axis), 0.4, 1) - gust_noise(p, 0.4, 1)) / h;
      EXPECT_LT((forth - back).norm(), 0.02) << at;  // curvature × h: no kink
    }
  }
  const Vec3 p(1.2, 3.4, 5.6);
  EXPECT_EQ(gust_noise(p, 1, 1), gust_noise(p, 1, 1));
  EXPECT_GT((gust_noise(p, 1, 1) - gust_noise(p, 1, 2)).norm(), 1e-3);
}

TEST(Gusts, AreCarriedByTheMeanWind) {
  // A plate that goes with the mean wind meets eddies that change only by their turnover.
  WindSettings settings = blowing(Vec3(0, 10, 0));
  settings.gust = 0.01;
  settings.gust_length = 1;
  Moving here = resting(plate(0.3));
  Moving there = here;
  there.time = 2;
  for (Vec3& p : there.x) p.y() += 20;
  const Vec3 a =
      force(settings, here, plate_triangles) - force(blowing(Vec3(0, 10, 0)), here, plate_triangles);
  const Vec3 b =
      force(settings, there, plate_triangles) - force(blowing(Vec3(0, 10, 0)), there, plate_triangles);
  EXPECT_GT(a.norm(), 1e-3);
  EXPECT_LT((a - b).norm(), 0.2 * a.norm());
}

TEST(Gusts, TravelUnchangedInAFrozenField) {
  // u(x, t) = u(x − U t, 0): a plate that has moved by U t meets the same air.
  WindSettings settings = blowing(Vec3(0, 8, 0));
  Field gusts;
  gusts.extent.window = always;
  gusts.extent.travel = Vec3(0, 8, 0);
  gusts.pattern = std::make_shared<Turbulence>(Turbulence::Settings{});
  settings.fields = {gusts};
  Moving here = resting(plate(0.3));
  Moving there = here;
  there.time = 2;
  for (Vec3& p : there.x) p.y() += 16;
  const Vec3 a = force(settings, here, plate_triangles), b = force(settings, there, plate_triangles);
  EXPECT_LT((a - b).norm(), 1e-10 * a.norm());
  EXPECT_GT((a - force(blowing(Vec3(0, 8, 0)), here, plate_triangles)).norm(), 1e-2);
}

TEST(Wind, FieldsAddToItsAir) {
  Field breeze;
  breeze.extent.window = always;
  breeze.extent.strength = 3;
  breeze.pattern = std::make_shared<UniformPattern>(Vec3::UnitX());
  Field counter = breeze;
  counter.extent.strength = -1;
  WindSettings settings = blowing(Vec3(0, 7, 0));
  settings.lift = 0.5;
  settings.fields = {breeze, counter};
  WindSettings sum = blowing(Vec3(2, 7, 0));
  sum.lift = 0.5;
  const Moving body = resting(plate(0.4));
  EXPECT_LT((force(settings, body, plate_triangles) - force(sum, body, plate_triangles)).norm(), 1e-12);
  settings.fields.front().extent.window = {10, 20};
  settings.fields.pop_back();
  const WindSettings calm = [&] {
    WindSettings s = settings;
    s.fields.clear();
    return s;
  }();
  EXPECT_EQ(force(settings, body, plate_triangles), force(calm, body, plate_triangles));
}

TEST(Wind, PorousSheetTakesTheForceOfItsSolidShare) {
  WindSettings settings = blowing(Vec3(1, 7, 2));
  settings.lift = 0.6;
  const Moving body = resting(plate(0.4));
  const Vec3 solid = force(settings, body, plate_triangles);
  settings.porosity = 0.3;
  EXPECT_LT((force(settings, body, plate_triangles) - 0.7 * solid).norm(), 1e-12);
  settings.porosity = 1;
  EXPECT_EQ(force(settings, body, plate_triangles), Vec3::Zero());
}

}  // namespace
}  // namespace muslin
