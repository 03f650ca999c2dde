// Contact energy and friction: scalar laws, derivatives by finite differences, shares, and that what rests
// stays.
#include "muslin/contact/contact_potential.hpp"

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "support/cloth_grid.hpp"
#include "support/distances_at.hpp"
#include "support/linearized_product.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/contact_energy.hpp"
#include "muslin/contact/contact_hessian.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

TEST(ContactLaw, HasConsistentDerivativesAndBeginsAsASpring) {
  const double range = 0.002, h = 1e-9;
  for (const double gap : {0.0001, 0.0006, 0.0009999, 0.0010001, 0.0015, 0.00199}) {
    const Law at = contact_law(gap, range);
    EXPECT_NEAR((contact_law(gap + h, range).value - contact_law(gap - h, range).value) / (2 * h), at.slope,
                1e-6 * range);
    EXPECT_NEAR((contact_law(gap + h, range).slope - contact_law(gap - h, range).slope) / (2 * h),
                at.curvature, 1e-4 * at.curvature);
  }
  // A spring of 1 N/m begins at the range; at half of it three times its force.
  const Law begins = contact_law(range * (1 - 1e-6), range);
  EXPECT_NEAR(begins.value, 0, 1e-17);
  EXPECT_NEAR(begins.slope, -1e-6 * range, 1e-11);
  EXPECT_NEAR(begins.curvature, 1, 1e-5);
  EXPECT_DOUBLE_EQ(contact_law(range / 2, range).slope, -1.5 * range);
  EXPECT_EQ(contact_law(range, range).value, 0);
  EXPECT_EQ(contact_law(0, range).value, std::numeric_limits<double>::infinity());
}

TEST(FrictionLaw, ReachesFullForceAtTheStickLength) {
  const double stick = 1e-5, h = 1e-11;
  for (const double slip : {1e-7, 4e-6, 9.9e-6, 1.1e-5, 3e-4}) {
    const Law at = friction_law(slip, stick);
    EXPECT_NEAR((friction_law(slip + h, stick).value - friction_law(slip - h, stick).value) / (2 * h),
                at.slope, 1e-4);
    EXPECT_DOUBLE_EQ(at.curvature * slip, at.slope);
  }
  EXPECT_DOUBLE_EQ(friction_law(stick, stick).slope, 1);
  EXPECT_EQ(friction_law(0, stick).value, 0);
  EXPECT_DOUBLE_EQ(friction_law(0, stick).curvature, 2 / stick);
}

/// Two crumpled sheets in contact on a plane, the upper one carried by eight vertices if asked.
struct Scene {
  std::shared_ptr<const ContactSurface> surface;
  std::shared_ptr<const SurfaceMap> map;
  std::vector<Vec3> q, start;
  double range = 0.02;

  explicit Scene(bool carried = false) {
    const test::ClothGrid sheet(5, 5, 0.1);
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> noise(-0.002, 0.002);
    std::vector<Vec3i> triangles = sheet.triangles;
    std::vector<int> bodies(25, 0), offsets = {0};
    std::vector<SurfaceMap::Entry> entries;
    for (const Vec3& p : sheet.positions) {
      entries.push_back({static_cast<int>(q.size()), 1});
      offsets.push_back(static_cast<int>(entries.size()));
      q.push_back(p + Vec3(noise(random), 0.012 + noise(random), noise(random)));
    }
    for (const Vec3i& t : sheet.triangles) triangles.push_back(t.array() + 25);
    bodies.resize(50, 1);
    const int first = static_cast<int>(q.size());
    if (carried) {
      for (int corner = 0; corner < 8; ++corner)
        q.push_back(Vec3(0.03 + 0.45 * (corner & 1), 0.4 * (corner >> 1 & 1), 0.02 + 0.44 * (corner >> 2)));
    }
    for (const Vec3& p : sheet.positions) {
      if (carried) {
        const double u = 2 * p.x(), v = 0.065 + noise(random), w = 2 * p.z();
        for (int c = 0; c < 8; ++c)
          entries.push_back(
              {first + c, (c & 1 ? u : 1 - u) * (c >> 1 & 1 ? v : 1 - v) * (c >> 2 ? w : 1 - w)});
      } else {
        entries.push_back({static_cast<int>(q.size()), 1});
        q.push_back(p + Vec3(0.033 + noise(random), 0.025 + noise(random), 0.021 + noise(random)));
      }
      offsets.push_back(static_cast<int>(entries.size()));
    }
    // The floor's point.
    entries.push_back({static_cast<int>(q.size()), 1});
    offsets.push_back(static_cast<int>(entries.size()));
    q.push_back(Vec3::Zero());
    bodies.push_back(2);
    surface = std::make_shared<ContactSurface>(
        triangles, bodies,
        std::vector<ContactBody>{{0.001, true, false}, {0.001, true, false}, {0, false, true}},
        std::vector<ContactPlane>{{50, Vec3(0, 1, 0)}});
    map = carried ? std::make_shared<SurfaceMap>(q.size(), offsets, entries)
                  : std::make_shared<SurfaceMap>(SurfaceMap::identity(q.size()));
    start = test::sum(q, 1, test::random_vectors(q.size(), 3e-5, 7));
  }

  ContactPotential potential(double friction, double stick = 2e-5) const {
    std::vector<Vec3> x(surface->point_count());
    map->apply(q, x);
    ContactCandidates candidates(surface, x, range);
    // The sheets are flat at rest, but x is as good: bodies are a twentieth of an edge apart.
    candidates.update(x, x, 0.002);
    return ContactPotential(test::distances_at(candidates, x), map, q, {friction, stick}, start);
  }
};

class ContactPotentialOf : public ::testing::TestWithParam<bool> {};

TEST_P(ContactPotentialOf, TakesOverTheFrictionOfAnother) {
  Scene scene(GetParam());
  const ContactPotential first = scene.potential(0.5);
  scene.q = test::sum(scene.q, 1, test::random_vectors(scene.q.size(), 2e-4, 11));
  std::vector<Vec3> x(scene.surface->point_count());
  scene.map->apply(scene.q, x);
  ContactCandidates candidates(scene.surface, x, scene.range);
  candidates.update(x, x, 0.002);
  const ContactPotential kept(test::distances_at(candidates, x), scene.map, scene.q, first),
      anew = scene.potential(0.5);
  EXPECT_GT(first.parts(scene.q).friction, 0);
  EXPECT_EQ(kept.parts(scene.q).friction, first.parts(scene.q).friction);
  EXPECT_NE(kept.parts(scene.q).friction, anew.parts(scene.q).friction);
  EXPECT_EQ(kept.parts(scene.q).normal, anew.parts(scene.q).normal);
}

TEST_P(ContactPotentialOf, HasTheTangentOfFrictionThatSlides) {
  // Without friction the gradient of contact is the same: the difference is that of friction.
  Scene scene(GetParam());
  const double stick = 1e-9;
  const ContactPotential rough = scene.potential(0.5, stick), smooth = scene.potential(0, stick);
  std::vector<Vec3> x(scene.surface->point_count());
  scene.map->apply(scene.q, x);
  ContactCandidates candidates(scene.surface, x, scene.range);
  candidates.update(x, x, 0.002);
  const ContactPotential tangent(test::distances_at(candidates, x), scene.map, scene.q, rough,
                                 SlidingStiffness::tangent);
  for (std::uint32_t seed = 1; seed < 4; ++seed) {
    const std::vector<Vec3> d = test::random_vectors(scene.q.size(), 1, seed);
    const double h = 1e-8;
    const auto slope = [&](const Potential& w) {
      return test::sum(test::gradient(w, test::sum(scene.q, h, d)), -1,
                       test::gradient(w, test::sum(scene.q, -h, d)));
    };
    const auto product = [&](const Potential& w) { return test::hessian_product(w, scene.q, d); };
    const std::vector<Vec3> expected = test::sum(slope(rough), -1, slope(smooth));
    const std::vector<Vec3> exact = test::sum(product(tangent), -1, product(smooth));
    const std::vector<Vec3> secant = test::sum(product(rough), -1, product(smooth));
    const double size = test::norm(expected) / (2 * h);
    EXPECT_GT(size, 0);
    EXPECT_LT(test::norm(test::sum(exact, -1 / (2 * h), expected)), 1e-4 * size);
    EXPECT_GT(test::norm(test::sum(secant, -1 / (2 * h), expected)), 0.1 * size);
    EXPECT_GE(test::inner(d, exact), 0);
    EXPECT_LE(test::inner(d, exact), test::inner(d, secant));
  }
  EXPECT_EQ(test::gradient(tangent, scene.q), test::gradient(rough, scene.q));
}

TEST_P(ContactPotentialOf, HasTheGradientOfItsValue) {
  const Scene scene(GetParam());
  for (const double friction : {0.0, 0.5}) {
    const ContactPotential w = scene.potential(friction);
    EXPECT_GT(w.term_count(), 40U);
    EXPECT_GT(w.value(scene.q), 0);
    const std::vector<Vec3> near = test::sum(scene.q, 1, test::random_vectors(scene.q.size(), 1e-5, 3));
    for (const std::vector<Vec3>& q : {scene.q, near}) {
      const std::vector<Vec3> g = test::gradient(w, q);
      for (std::uint32_t seed = 1; seed < 8; ++seed) {
        const std::vector<Vec3> d = test::random_vectors(q.size(), 1, seed);
        const double h = 1e-8;
        const double slope = (w.value(test::sum(q, h, d)) - w.value(test::sum(q, -h, d))) / (2 * h);
        EXPECT_NEAR(slope, test::inner(g, d), 2e-6 * test::norm(g) * test::norm(d));
      }
    }
  }
}

TEST_P(ContactPotentialOf, HasASymmetricPositiveHessianWithItsDiagonal) {
  const Scene scene(GetParam());
  const ContactPotential w = scene.potential(0.5);
  test::expect_hessian_symmetric(w, scene.q);
  test::expect_diagonal_blocks_positive_semidefinite(w, scene.q);
  test::expect_adds(w, scene.q);
  test::expect_same_bits_for_any_thread_count(w, scene.q);
  std::vector<Mat3> blocks(scene.q.size(), Mat3::Zero());
  w.add_diagonal_blocks(scene.q, blocks);
  for (std::size_t v = 0; v < scene.q.size(); ++v) {
    for (int k = 0; k < 3; ++k) {
      std::vector<Vec3> unit(scene.q.size(), Vec3::Zero());
      unit[v][k] = 1;
      const std::vector<Vec3> column = test::hessian_product(w, scene.q, unit);
      EXPECT_LT((column[v] - blocks[v].col(k)).norm(), 1e-9 * (1 + blocks[v].norm()));
      EXPECT_GE(test::inner(unit, column), 0);
    }
  }
}

TEST_P(ContactPotentialOf, HasNoNetForceAndTorque) {
  // Action and reaction: between all bodies, the floor too, forces add to nothing.
  const Scene scene(GetParam());
  const std::vector<Vec3> g = test::gradient(scene.potential(0.5), scene.q);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& f : g) sum += f;
  EXPECT_LT(sum.norm(), 1e-12 * test::norm(g) * static_cast<double>(g.size()));
}

INSTANTIATE_TEST_SUITE_P(Maps, ContactPotentialOf, ::testing::Bool(),
                         [](const auto& carried) { return carried.param ? "Carried" : "Identity"; });

TEST(ContactPotential, LinearizesToItsHessian) {
  const Scene scene;
  const ContactPotential w = scene.potential(0.3);
  const std::vector<double> masses(scene.q.size(), 0);
  const std::vector<std::uint8_t> fixed(scene.q.size(), 0);
  Linearization linearization;
  linearization.reset(masses, fixed, 1);
  w.linearize(scene.q, linearization, 0);
  linearization.finish();
  const std::vector<Vec3> p = test::random_vectors(scene.q.size(), 1, 4);
  const std::vector<Vec3> expected = test::hessian_product(w, scene.q, p);
  const std::vector<Vec3> product = test::product(linearization, p);
  for (std::size_t v = 0; v < p.size(); ++v)
    EXPECT_LT((product[v] - expected[v]).norm(), 1e-4 * (1 + test::norm(expected)));
}

/// A lone point over a fixed sheet, whose surface is softer and decides: 1000 N/m.
struct PointOverSheet {
  test::ClothGrid sheet;
  double range = 0.002;
  double alone = -1000 * contact_law(range / 2, range).slope;  ///< force of one contact at half the range [N]
  std::shared_ptr<const ContactSurface> surface;
  std::shared_ptr<const SurfaceMap> map;

  explicit PointOverSheet(int side = 5, double spacing = 0.1) : sheet(side, side, spacing) {
    const int point = side * side;
    map = std::make_shared<SurfaceMap>(SurfaceMap::identity(static_cast<std::size_t>(point) + 1));
    std::vector<Vec3i> triangles = sheet.triangles;
    triangles.emplace_back(point, point, point);
    std::vector<int> bodies(static_cast<std::size_t>(point), 0);
    bodies.push_back(1);
    surface = std::make_shared<ContactSurface>(
        triangles, bodies, std::vector<ContactBody>{{0, false, false, INFINITY}, {0, false, false, 1000}});
  }
  /// On the point [N].
  Vec3 force(const Vec3& at) const {
    std::vector<Vec3> q = sheet.positions;
    q.push_back(at);
    ContactCandidates candidates(surface, q, range);
    candidates.update(q, q, range / 2);
    const ContactPotential w(test::distances_at(candidates, q), map, q, {0, 1e-5}, q);
    return -test::gradient(w, q).back();
  }
  /// Height of the sheet at x, z.
  double height(double x, double z) const {
    for (const Vec3i& t : sheet.triangles) {
      const auto corner = [&](int k) { return sheet.positions[static_cast<std::size_t>(t[k])]; };
      const Vec3 u = corner(1) - corner(0), v = corner(2) - corner(0), p = Vec3(x, 0, z) - corner(0);
      const double area = u.x() * v.z() - u.z() * v.x();
      const double s = (p.x() * v.z() - p.z() * v.x()) / area, r = (u.x() * p.z() - u.z() * p.x()) / area;
      if (s >= -1e-12 && r >= -1e-12 && s + r <= 1 + 1e-12) return corner(0).y() + s * u.y() + r * v.y();
    }
    return INFINITY;
  }
};

TEST(ContactPotential, CountsEveryContactOnce) {
  // The force is equal over faces, edges and corners.
  const PointOverSheet scene;
  for (const Vec3& over :
       {Vec3(0.23, 0.001, 0.22), Vec3(0.2, 0.001, 0.25), Vec3(0.2, 0.001, 0.2), Vec3(0.25, 0.001, 0.25)})
    EXPECT_NEAR(scene.force(over).y(), scene.alone, 1e-9) << over.transpose();
}

TEST(ContactPotential, CountsAContactOnceAmongAThousandTriangles) {
  // The range is ten edges of the sheet.
  const PointOverSheet scene(41, 0.0002);
  for (const Vec3& over :
       {Vec3(0.00413, 0.001, 0.00411), Vec3(0.004, 0.001, 0.0041), Vec3(0.004, 0.001, 0.004)})
    EXPECT_NEAR(scene.force(over).y(), scene.alone, 1e-9) << over.transpose();
}

TEST(MergedContacts, ListEachContactOfABallNearManyTrianglesOnce) {
  // Two balls over cloth of millimetres, near to a thousand triangles each, some of them the same.
  constexpr double radius = 0.25, range = 0.001;
  constexpr int side = 24, sheet_points = side * side;
  const test::ClothGrid sheet(side, side, 0.002);
  std::vector<Vec3> x = sheet.positions;
  x.push_back(Vec3(0.012, radius + 0.0002, 0.012));
  x.push_back(Vec3(0.035, radius + 0.0003, 0.033));
  std::vector<Vec3i> triangles = sheet.triangles;
  std::vector<int> bodies(sheet_points, 0);
  for (int ball = 0; ball < 2; ++ball) {
    triangles.push_back(Vec3i::Constant(sheet_points + ball));
    bodies.push_back(1 + ball);
  }
  const auto surface = std::make_shared<ContactSurface>(
      triangles, bodies,
      std::vector<ContactBody>{
          {0, false, true, INFINITY}, {radius, false, false, 1000}, {radius, false, false, 500}});
  ContactCandidates candidates(surface, x, range);
  candidates.update(x, x, range / 2);
  const PairDistances distances = test::distances_at(candidates, x);
  set_thread_count(1);
  const std::vector<ContactTerm> terms = contact_terms(distances, 1.0 / 240);
  set_thread_count(4);
  const std::vector<ContactTerm> again = contact_terms(distances, 1.0 / 240);
  set_thread_count(0);
  ASSERT_EQ(again.size(), terms.size());
  for (std::size_t i = 0; i < terms.size(); ++i) EXPECT_EQ(again[i].points, terms[i].points);
  const std::vector<MergedContact> merged = merged_contacts(*surface, terms, x);
  for (int ball = 0; ball < 2; ++ball) {
    // A ball meets cloth so fine at its vertices, at each once.
    std::set<int> near, met;
    for (int v = 0; v < sheet_points; ++v) {
      const double gap =
          (x[static_cast<std::size_t>(v)] - x[static_cast<std::size_t>(sheet_points + ball)]).norm() - radius;
      if (gap < PairDistances::ranges_known * range) near.insert(v);
    }
    Vec3 expected = Vec3::Zero(), sum = expected;
    for (const ContactTerm& term : terms) {
      if (term.points[0] != sheet_points + ball) continue;
      EXPECT_TRUE(met.insert(term.points[1]).second) << "twice";
      EXPECT_EQ(term.stiffness, ball == 0 ? 1000 : 500);
      const PairGeometry at = term_geometry(*surface, term, x);
      expected += term.stiffness * contact_law(at.distance - term.thickness, term.range).slope * at.normal;
    }
    std::set<std::pair<int, std::array<int, 4>>> places;
    for (const MergedContact& contact : merged) {
      if (contact.points[0] != sheet_points + ball) continue;
      EXPECT_TRUE(places.insert({contact.first_size, contact.points}).second) << "named twice";
      sum += contact.slope * contact.normal;
    }
    EXPECT_EQ(met, near);
    EXPECT_GT(places.size(), 50U);
    EXPECT_LT((sum - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST(ContactPotential, CountsAContactAboutOnceNearEdgesAndCorners) {
  const PointOverSheet scene;
  double least = scene.alone, most = scene.alone;
  for (int i = 0; i <= 60; ++i) {
    for (int k = 0; k <= 60; ++k) {
      const double force = scene.force({0.1 + 1e-4 * i, 0.001, 0.1 + 1e-4 * k}).y();
      least = std::min(least, force);
      most = std::max(most, force);
    }
  }
  EXPECT_GT(least, 0.8 * scene.alone);
  EXPECT_LT(most, 1.3 * scene.alone);
}

TEST(ContactPotential, HasContinuousForces) {
  // Where they do there may be no balance, and Newton's method goes to and fro. Over ridges, valleys and
  // corners of a crumpled sheet, each stretch of the way is halved where the force changes more.
  PointOverSheet scene;
  const std::vector<Vec3> noise = test::random_vectors(25, 1, 5);
  for (std::size_t v = 0; v < 25; ++v)
    scene.sheet.positions[v] += Vec3(0.02, 0.04, 0.02).cwiseProduct(noise[v]);
  double largest = 0;
  for (const auto& [from, to] : {std::pair{Vec3(0.12, 0, 0.11), Vec3(0.31, 0, 0.24)},
                                 std::pair{scene.sheet.positions[12], Vec3(scene.sheet.positions[13])},
                                 std::pair{scene.sheet.positions[6], Vec3(scene.sheet.positions[12])}}) {
    const auto force = [&, from = from, to = to](double t) {
      Vec3 at = from + t * (to - from);
      at.y() = scene.height(at.x(), at.z()) + 0.6 * scene.range;
      return scene.force(at);
    };
    constexpr int stretches = 300;
    for (int i = 0; i < stretches; ++i) {
      double a = static_cast<double>(i) / stretches, b = static_cast<double>(i + 1) / stretches;
      Vec3 at_a = force(a), at_b = force(b);
      while (b - a > 1e-7) {
        const double middle = (a + b) / 2;
        const Vec3 at_middle = force(middle);
        if ((at_middle - at_a).norm() > (at_b - at_middle).norm()) {
          b = middle, at_b = at_middle;
        } else {
          a = middle, at_a = at_middle;
        }
      }
      largest = std::max(largest, (at_b - at_a).norm());
    }
  }
  EXPECT_LT(largest, 1e-3);
}

/// A particle of 1 kg on a plane, minimising contact, gravity along and across it, and inertia, by Newton's
/// method with lagged friction; returns how far it has slid after 200 and 400 steps of 1/240 s.
std::array<double, 2> slide(double friction, double slope) {
  double halfway = 0;
  const auto surface = std::make_shared<ContactSurface>(
      std::vector<Vec3i>{{0, 0, 0}}, std::vector<int>{0, 1},
      std::vector<ContactBody>{{0, true, false, 30000}, {0, false, true, INFINITY}},
      std::vector<ContactPlane>{{1, Vec3(0, 1, 0)}});
  const auto map = std::make_shared<SurfaceMap>(SurfaceMap::identity(2));
  const double range = 0.002, dt = 1.0 / 240, g = 9.81;
  const Vec3 gravity = g * Vec3(std::sin(slope), -std::cos(slope), 0);
  std::vector<Vec3> q = {Vec3(0, 0.0015, 0), Vec3::Zero()};
  ContactCandidates candidates(surface, q, range);
  std::vector<PairSlip> slips;
  Vec3 velocity = Vec3::Zero();
  for (int step = 0; step < 400; ++step) {
    const std::vector<Vec3> start = q;
    const Vec3 predicted = q[0] + dt * velocity + dt * dt * gravity;
    candidates.update(q, q, 0.01);
    for (int iteration = 0; iteration < 12; ++iteration) {
      const ContactPotential w(test::distances_at(candidates, q), map, q, {friction, 4e-6}, start, slips);
      std::vector<Mat3> blocks(2, Mat3::Zero());
      w.add_diagonal_blocks(q, blocks);
      const Vec3 residual = (q[0] - predicted) / (dt * dt) + test::gradient(w, q)[0];
      const Mat3 hessian = Mat3::Identity() / (dt * dt) + blocks[0];
      Vec3 move = -hessian.inverse() * residual;
      move.y() = std::max(move.y(), -0.9 * q[0].y());
      q[0] += move;
      if (iteration == 11) slips = w.slips(q);
    }
    velocity = (q[0] - start[0]) / dt;
    if (step == 199) halfway = q[0].x();
  }
  return {halfway, q[0].x()};
}

TEST(Friction, SticksBelowTheFrictionAngleAndSlidesAsCoulombAbove) {
  const double slope = std::atan(0.3), time = 400.0 / 240;
  const auto [landed, later] = slide(0.33, slope);  // at 90 % of the limit
  EXPECT_LT(landed, 2e-4);
  EXPECT_LT(std::fabs(later - landed), 1e-9);  // no creep
  const double expected = 0.5 * 9.81 * (std::sin(slope) - 0.1 * std::cos(slope)) * time * time;
  EXPECT_NEAR(slide(0.1, slope)[1], expected, 0.01 * expected);
}

/// Two balls that turn, each carried by four vertices, on a floor and side by side.
struct Balls {
  static constexpr double radius = 0.1, range = 0.004;
  std::shared_ptr<const ContactSurface> surface;
  std::shared_ptr<const SurfaceMap> map;
  std::vector<Vec3> q;

  Balls() {
    std::vector<int> offsets = {0};
    std::vector<SurfaceMap::Entry> entries;
    for (const Vec3& centre : {Vec3(0, radius + 0.001, 0), Vec3(2 * radius + 0.002, radius + 0.0015, 0.01)}) {
      for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)}) {
        entries.push_back({static_cast<int>(q.size()), 0.25});
        q.push_back(centre + 0.06 * corner);
      }
      offsets.push_back(static_cast<int>(entries.size()));
    }
    entries.push_back({static_cast<int>(q.size()), 1});
    offsets.push_back(static_cast<int>(entries.size()));
    q.push_back(Vec3::Zero());
    ContactBody first{radius, false, false}, second = first;
    first.frame = {0, 1, 2, 3};
    second.frame = {4, 5, 6, 7};
    surface =
        std::make_shared<ContactSurface>(std::vector<Vec3i>{{0, 0, 0}, {1, 1, 1}}, std::vector<int>{0, 1, 2},
                                         std::vector<ContactBody>{first, second, {0, false, true}},
                                         std::vector<ContactPlane>{{2, Vec3(0, 1, 0)}});
    map = std::make_shared<SurfaceMap>(q.size(), offsets, entries);
  }
  ContactPotential potential(ConstVectors start, double stick = 2e-5) const {
    std::vector<Vec3> x(surface->point_count());
    map->apply(q, x);
    ContactCandidates candidates(surface, x, range);
    candidates.update(x, x, 0.002);
    return ContactPotential(test::distances_at(candidates, x), map, q, {0.5, stick}, start);
  }
  /// The first ball moved by `shift` and turned about its centre by `angle` about z.
  std::vector<Vec3> moved(const Vec3& shift, double angle) const {
    std::vector<Vec3> to = q;
    const Vec3 centre = (q[0] + q[1] + q[2] + q[3]) / 4;
    for (std::size_t i = 0; i < 4; ++i)
      to[i] = centre + shift + Eigen::AngleAxisd(angle, Vec3::UnitZ()) * (q[i] - centre);
    return to;
  }
};

TEST(TurningBall, HasTheGradientOfItsValueAndAPositiveHessian) {
  const Balls balls;
  const ContactPotential w =
      balls.potential(test::sum(balls.q, 1, test::random_vectors(balls.q.size(), 3e-5, 7)));
  EXPECT_EQ(w.term_count(), 4U);  // each on the floor; each centre and the other ball
  const std::vector<Vec3> q = test::sum(balls.q, 1, test::random_vectors(balls.q.size(), 1e-5, 3));
  const std::vector<Vec3> g = test::gradient(w, q);
  for (std::uint32_t seed = 1; seed < 8; ++seed) {
    const std::vector<Vec3> d = test::random_vectors(q.size(), 1, seed);
    const double h = 1e-8;
    const double slope = (w.value(test::sum(q, h, d)) - w.value(test::sum(q, -h, d))) / (2 * h);
    EXPECT_NEAR(slope, test::inner(g, d), 2e-6 * test::norm(g) * test::norm(d));
  }
  test::expect_hessian_symmetric(w, q);
  test::expect_diagonal_blocks_positive_semidefinite(w, q);
}

TEST(TurningBall, HasFrictionWhereItSlipsAndNoneWhereItRolls) {
  Balls balls;
  for (std::size_t i = 4; i < 8; ++i) balls.q[i].x() += 1;  // out of the way
  const double stick = 1e-6, angle = 1e-4, way = angle * Balls::radius;
  const ContactPotential w = balls.potential(balls.q, stick);
  // Turning by a positive angle about z the lowest point goes along +x.
  const double spun = w.parts(balls.moved(Vec3::Zero(), angle)).friction,
               slid = w.parts(balls.moved(Vec3(way, 0, 0), 0)).friction,
               rolled = w.parts(balls.moved(Vec3(-way, 0, 0), angle)).friction;
  EXPECT_GT(slid, 0);
  EXPECT_NEAR(spun, slid, 0.02 * slid);  // the gap adds to the arm of 0.1 m
  EXPECT_LT(rolled, 1e-3 * slid);
}

TEST(ContactPotential, RefusesInvalidInput) {
  const Scene scene;
  EXPECT_THROW(scene.potential(-1), Error);
  EXPECT_THROW(scene.potential(1, 0), Error);
}

}  // namespace
}  // namespace muslin
