// The guarantee: whatever step is asked for, the limited one crosses nothing, judged by exact predicates.
#include "muslin/contact/step_limiter.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "support/distances_at.hpp"
#include "support/draped_cloth.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/intersections.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

/// Surfaces, their map and where the vertices are.
struct Scene {
  std::shared_ptr<const ContactSurface> surface;
  std::shared_ptr<const SurfaceMap> map;
  std::vector<Vec3> rest, q;
  double contact_distance = 0;

  ContactCandidates candidates() const {
    std::vector<Vec3> x(surface->point_count());
    map->apply(rest, x);
    return ContactCandidates(surface, x, contact_distance);
  }
  std::vector<Vec3> points(ConstVectors vertices) const {
    std::vector<Vec3> x(surface->point_count());
    map->apply(vertices, x);
    return x;
  }
  bool crosses() const {
    return !find_intersections(points(q), surface->triangles(), {.limit = 1, .wanted = {}}).empty();
  }
};

Scene cloth_scene(int n) {
  const test::ClothGrid cloth = test::draped_cloth(n);
  Scene scene;
  scene.rest = test::ClothGrid(n, n, 1.0 / (n - 1)).positions;
  scene.q = cloth.positions;
  scene.surface = std::make_shared<ContactSurface>(
      cloth.triangles, std::vector<int>(cloth.positions.size(), 0), std::vector<ContactBody>{{}});
  scene.map = std::make_shared<SurfaceMap>(SurfaceMap::identity(scene.q.size()));
  scene.contact_distance = std::min(2e-3, 0.2 / (n - 1));
  return scene;
}

/// Takes a limited step towards q + dq with pairs for wherever points may stop on the way.
LimitReport limited_step(Scene& scene, ContactCandidates& candidates, const StepLimiter& limiter,
                         std::vector<Vec3> dq, double margin) {
  std::vector<Vec3> to = scene.q;
  for (std::size_t v = 0; v < to.size(); ++v) to[v] += dq[v];
  const std::vector<std::uint8_t> all(scene.surface->point_count(), 1);
  candidates.update(scene.points(scene.q), scene.points(scene.q), margin);
  candidates.renew(all, scene.points(scene.q), scene.points(to), margin);
  PairDistances distances = test::distances_at(candidates, scene.points(scene.q));
  const LimitReport report = limiter.limit(distances, dq);
  for (std::size_t v = 0; v < to.size(); ++v) scene.q[v] += dq[v];
  return report;
}

std::vector<Vec3> random_step(std::size_t count, double size, std::mt19937_64& random) {
  std::normal_distribution<double> noise(0, size);
  std::vector<Vec3> step(count);
  for (Vec3& d : step) d = Vec3(noise(random), noise(random), noise(random));
  return step;
}

class ViolentSteps : public ::testing::TestWithParam<int> {};

TEST_P(ViolentSteps, NeverMakeCrumpledClothCrossItself) {
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  Scene scene = cloth_scene(14);
  ASSERT_FALSE(scene.crosses());
  ContactCandidates candidates = scene.candidates();
  const StepLimiter limiter(scene.map,
                            {.gap_floor = 0.005 * scene.contact_distance, .prescribed = {}, .groups = {}});
  const double edge = 1.0 / 13;
  double moved = 0;
  std::size_t shortened = 0;
  for (int step = 0; step < 10; ++step) {
    std::vector<Vec3> dq;
    switch (step % 5) {
      case 0:  // each vertex anywhere
        dq = random_step(scene.q.size(), 2 * edge, random);
        break;
      case 1:  // collapse towards a point
        for (const Vec3& p : scene.q) dq.push_back(0.7 * (Vec3(0.1, 0.1, 0) - p));
        break;
      case 2:  // turn inside out
        for (const Vec3& p : scene.q) dq.push_back(-2 * p);
        break;
      case 3:  // flatten
        for (const Vec3& p : scene.q) dq.push_back(Vec3(0, -p.y(), 0));
        break;
      default:  // shear layers past each other
        for (const Vec3& p : scene.q)
          dq.push_back(Vec3(std::sin(40 * p.y()), 0.3, std::cos(31 * p.y())) * 0.1);
        break;
    }
    const std::vector<Vec3> before = scene.q;
    const LimitReport report = limited_step(scene, candidates, limiter, dq, 1e-3);
    for (std::size_t v = 0; v < before.size(); ++v) moved += (scene.q[v] - before[v]).norm();
    shortened += report.shortened;
    ASSERT_FALSE(scene.crosses()) << "step " << step;
    ASSERT_GT(test::distances_at(candidates, scene.q).smallest_gap(), 0.0049 * scene.contact_distance)
        << "step " << step;
  }
  EXPECT_GT(moved / static_cast<double>(scene.q.size()), 0.1);  // it was violent
  EXPECT_GT(shortened, 300U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ViolentSteps, ::testing::Range(1, 4));

TEST(StepLimiter, DoesNotChangeASafeStep) {
  Scene scene = cloth_scene(20);
  ContactCandidates candidates = scene.candidates();
  const StepLimiter limiter(scene.map, {});
  const std::vector<Vec3> dq(scene.q.size(), Vec3(0.01, -0.02, 0.03));
  const std::vector<Vec3> before = scene.q;
  const LimitReport report = limited_step(scene, candidates, limiter, dq, 1e-3);
  EXPECT_EQ(report.deflected + report.clipped + report.shortened, 0U);
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_EQ(scene.q[v], before[v] + dq[v]);
}

TEST(StepLimiter, RemovesOnlyTheNormalApproach) {
  // A sheet slides over another while it is pressed down.
  const test::ClothGrid sheet(6, 6, 0.1);
  Scene scene;
  std::vector<Vec3i> triangles = sheet.triangles;
  std::vector<int> bodies(36, 0);
  scene.q = sheet.positions;
  for (const Vec3& p : sheet.positions) scene.q.push_back(Vec3(0.5 * p.x() + 0.1, 0.002, 0.5 * p.z() + 0.13));
  for (const Vec3i& t : sheet.triangles) triangles.push_back(t.array() + 36);
  bodies.resize(72, 1);
  scene.surface = std::make_shared<ContactSurface>(triangles, bodies, std::vector<ContactBody>{{}, {}});
  scene.map = std::make_shared<SurfaceMap>(SurfaceMap::identity(72));
  scene.rest = scene.q;
  scene.contact_distance = 0.002;
  ContactCandidates candidates = scene.candidates();
  const StepLimiter limiter(scene.map, {});
  std::vector<Vec3> dq(72, Vec3::Zero());
  for (std::size_t v = 36; v < 72; ++v) dq[v] = Vec3(0.03, -0.05, 0);
  const LimitReport report = limited_step(scene, candidates, limiter, dq, 1e-3);
  EXPECT_FALSE(scene.crosses());
  EXPECT_EQ(report.shortened, 0U);
  for (std::size_t v = 36; v < 72; ++v) {
    EXPECT_NEAR(scene.q[v].x(), 0.5 * sheet.positions[v - 36].x() + 0.13, 1e-9);
    EXPECT_GT(scene.q[v].y(), 0);
    EXPECT_LT(scene.q[v].y(), 0.00101);  // half of the contact distance
  }
}

TEST(StepLimiter, SeparatesSpheresCapsulesAndPlanes) {
  // Cloth thrown onto a plane, a ball and a pole, faster than anything is thick.
  const test::ClothGrid sheet(15, 15, 0.05);
  Scene scene;
  scene.q = sheet.positions;
  for (Vec3& p : scene.q) p += Vec3(-0.35, 0.5, -0.35);
  std::vector<Vec3i> triangles = sheet.triangles;
  const int n = static_cast<int>(scene.q.size());
  std::vector<int> bodies(scene.q.size(), 0);
  for (const Vec3& p : {Vec3(0.1, 0.1, 0), Vec3(-0.3, 0.05, -0.4), Vec3(-0.2, 0.1, 0.4), Vec3(0, 0, 0)})
    scene.q.push_back(p);
  for (const int body : {1, 2, 2, 3}) bodies.push_back(body);
  triangles.emplace_back(n, n, n);
  triangles.emplace_back(n + 1, n + 2, n + 2);
  scene.surface = std::make_shared<ContactSurface>(
      triangles, bodies,
      std::vector<ContactBody>{{}, {0.1, false, true}, {0.03, false, true}, {0, false, true}},
      std::vector<ContactPlane>{{n + 3, Vec3(0, 1, 0)}});
  scene.map = std::make_shared<SurfaceMap>(SurfaceMap::identity(scene.q.size()));
  scene.rest = scene.q;
  scene.contact_distance = 0.002;
  ContactCandidates candidates = scene.candidates();
  const StepLimiter limiter(scene.map, {});
  for (int step = 0; step < 12; ++step) {
    std::vector<Vec3> dq(scene.q.size(), Vec3::Zero());
    for (std::size_t v = 0; v < static_cast<std::size_t>(n); ++v) dq[v] = Vec3(0, -0.3, 0.01);
    limited_step(scene, candidates, limiter, dq, 1e-3);
    EXPECT_GT(test::distances_at(candidates, scene.q).smallest_gap(), 0.9e-5) << step;
    const Vec3 ball = scene.q[static_cast<std::size_t>(n)];
    for (const Vec3i& t : sheet.triangles) {
      const auto at = [&](int i) { return scene.q[static_cast<std::size_t>(t[i])]; };
      EXPECT_GT(closest_vertex_triangle(ball, at(0), at(1), at(2)).distance(), 0.1);
      EXPECT_GT(at(0).y(), 0);
    }
  }
  EXPECT_LT(scene.q[224].y(), 0.01);                                   // the corner reached the floor
  EXPECT_GT(scene.q[static_cast<std::size_t>(7 * 15 + 9)].y(), 0.15);  // above the ball
}

TEST(StepLimiter, KeepsThicknessUnderSustainedPressure) {
  // A ball of 1 m on a triangle, pushed down for as long as it takes to lose a millionth of its radius a
  // step.
  Scene scene;
  scene.q = {Vec3(-3, 0, -3), Vec3(3, 0, -3), Vec3(0, 0, 3), Vec3(0, 1.001, 0)};
  scene.surface =
      std::make_shared<ContactSurface>(std::vector<Vec3i>{{0, 1, 2}, {3, 3, 3}}, std::vector<int>{0, 0, 0, 1},
                                       std::vector<ContactBody>{{0, false, true}, {1, false, false}});
  scene.map = std::make_shared<SurfaceMap>(SurfaceMap::identity(4));
  scene.rest = scene.q;
  scene.contact_distance = 0.002;
  ContactCandidates candidates = scene.candidates();
  const StepLimiter limiter(scene.map, {});
  for (int step = 0; step < 100; ++step) {
    std::vector<Vec3> dq(4, Vec3::Zero());
    dq[3] = Vec3(0, -0.01, 0);
    limited_step(scene, candidates, limiter, dq, 1e-3);
    ASSERT_GT(scene.q[3].y(), 1 + 0.99e-5) << step;
  }
}

TEST(StepLimiter, ClothYieldsToAMovingCollider) {
  // A triangle moved along keyframes hits a free sheet from below.
  const test::ClothGrid sheet(9, 9, 0.05);
  Scene scene;
  scene.q = sheet.positions;
  std::vector<Vec3i> triangles = sheet.triangles;
  const int n = static_cast<int>(scene.q.size());
  std::vector<int> bodies(scene.q.size(), 0);
  for (const Vec3& p : {Vec3(0.1, -0.01, 0.1), Vec3(0.3, -0.02, 0.12), Vec3(0.21, -0.015, 0.3)}) {
    scene.q.push_back(p);
    bodies.push_back(1);
  }
  triangles.emplace_back(n, n + 1, n + 2);
  scene.surface =
      std::make_shared<ContactSurface>(triangles, bodies, std::vector<ContactBody>{{}, {0, false, true}});
  scene.map = std::make_shared<SurfaceMap>(SurfaceMap::identity(scene.q.size()));
  scene.rest = scene.q;
  scene.contact_distance = 0.002;
  StepLimits limits;
  limits.prescribed.assign(scene.q.size(), 0);
  limits.groups.assign(scene.q.size(), -1);
  for (int i = 0; i < 3; ++i) {
    limits.prescribed[static_cast<std::size_t>(n + i)] = 1;
    limits.groups[static_cast<std::size_t>(n + i)] = 0;
  }
  ContactCandidates candidates = scene.candidates();
  const StepLimiter limiter(scene.map, limits);
  const std::vector<Vec3> start(scene.q.end() - 3, scene.q.end());
  for (int step = 0; step < 20; ++step) {
    std::vector<Vec3> dq(scene.q.size(), Vec3::Zero());
    for (std::size_t v = static_cast<std::size_t>(n); v < dq.size(); ++v) dq[v] = Vec3(0, 0.02, 0);
    limited_step(scene, candidates, limiter, dq, 5e-2);
    ASSERT_FALSE(scene.crosses()) << step;
    // It keeps its shape.
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 shift = scene.q[static_cast<std::size_t>(n) + i] - start[i];
      EXPECT_LT((shift - (scene.q[static_cast<std::size_t>(n)] - start[0])).norm(), 1e-14);
    }
  }
  EXPECT_GT(scene.q.back().y() - start[2].y(), 0.2);  // and goes its way, with the cloth before it
}

TEST(StepLimiter, ProtectsCarriedSurfaces) {
  // Two sheets of points carried by coarse boxes of eight vertices each, thrown at each other.
  Scene scene;
  std::vector<int> offsets = {0}, bodies;
  std::vector<SurfaceMap::Entry> entries;
  std::vector<Vec3i> triangles;
  const test::ClothGrid sheet(6, 6, 0.2);
  for (int body = 0; body < 2; ++body) {
    const int first = 8 * body, point = 36 * body;
    for (int corner = 0; corner < 8; ++corner)
      scene.q.push_back(Vec3(corner & 1, 0.25 * (corner >> 1 & 1) + 0.3 * body, corner >> 2));
    for (const Vec3& p : sheet.positions) {
      const double height = body == 0 ? 0.9 : 0.1;
      for (int corner = 0; corner < 8; ++corner) {
        const double weight = (corner & 1 ? p.x() : 1 - p.x()) * (corner >> 1 & 1 ? height : 1 - height) *
                              (corner >> 2 ? p.z() : 1 - p.z());
        entries.push_back({first + corner, weight});
      }
      offsets.push_back(static_cast<int>(entries.size()));
      bodies.push_back(body);
    }
    for (const Vec3i& t : sheet.triangles) triangles.push_back(t.array() + point);
  }
  for (SurfaceMap::Entry& e : entries) e.weight = std::max(e.weight, 0.0);
  scene.surface = std::make_shared<ContactSurface>(triangles, bodies, std::vector<ContactBody>{{}, {}});
  scene.map = std::make_shared<SurfaceMap>(16, offsets, entries);
  scene.rest = scene.q;
  scene.contact_distance = 0.005;
  ContactCandidates candidates = scene.candidates();
  const StepLimiter limiter(scene.map, {});
  std::mt19937_64 random(4);
  for (int step = 0; step < 30; ++step) {
    std::vector<Vec3> dq = random_step(16, 0.1, random);
    for (std::size_t v = 0; v < 16; ++v) dq[v].y() += v < 8 ? 0.1 : -0.1;
    limited_step(scene, candidates, limiter, dq, 1e-2);
    ASSERT_FALSE(scene.crosses()) << step;
    ASSERT_GT(test::distances_at(candidates, scene.points(scene.q)).smallest_gap(), 0.9e-5) << step;
  }
}

TEST(StepLimiter, GivesTheSameBitsForAnyThreadCount) {
  std::mt19937_64 random(9);
  const Scene scene = cloth_scene(40);
  const std::vector<Vec3> dq = random_step(scene.q.size(), 0.03, random);
  const StepLimiter limiter(scene.map, {});
  std::vector<std::vector<Vec3>> results;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    Scene copy = scene;
    ContactCandidates candidates = copy.candidates();
    limited_step(copy, candidates, limiter, dq, 1e-3);
    results.push_back(copy.q);
  }
  set_thread_count(0);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(StepLimiter, FreeClothSlidesOverAFloorWithoutLocking) {
  // Gaps at the floor must not stop what moves along or away.
  Scene scene = cloth_scene(12);
  ContactCandidates candidates = scene.candidates();
  const StepLimiter limiter(scene.map, {});
  for (int step = 0; step < 10; ++step) {
    std::vector<Vec3> dq;
    for (const Vec3& p : scene.q) dq.push_back(0.9 * (Vec3(0, 0, 0) - p));
    limited_step(scene, candidates, limiter, dq, 1e-3);
  }
  const std::vector<Vec3> crumpled = scene.q;
  std::vector<Vec3> dq;
  for (const Vec3& p : scene.q) dq.push_back(p);  // and apart again
  const LimitReport report = limited_step(scene, candidates, limiter, dq, 1e-3);
  EXPECT_EQ(report.shortened, 0U);
  for (std::size_t v = 0; v < crumpled.size(); ++v) EXPECT_LT((scene.q[v] - 2 * crumpled[v]).norm(), 1e-9);
}

TEST(StepLimiter, KeepsTheRequestedShareOfEveryGap) {
  // A motion that ends short of the floor is stopped there as well.
  for (const double share : {0.0, 0.4}) {
    std::mt19937_64 random(3);
    Scene scene = cloth_scene(14);
    ContactCandidates candidates = scene.candidates();
    const StepLimiter limiter(
        scene.map,
        {.gap_floor = 1e-5 * scene.contact_distance, .kept_share = share, .prescribed = {}, .groups = {}});
    double before = scene.contact_distance, least_kept = 1;
    for (int step = 0; step < 8; ++step) {
      limited_step(scene, candidates, limiter, random_step(scene.q.size(), 0.05, random), 1e-3);
      const double gap =
          std::min(test::distances_at(candidates, scene.q).smallest_gap(), scene.contact_distance);
      least_kept = std::min(least_kept, gap / before);
      before = gap;
    }
    if (share > 0) {
      EXPECT_GT(least_kept, 0.99 * share);
    } else {
      EXPECT_LT(least_kept, 0.3);
    }
  }
}

TEST(StepLimiter, RefusesInvalidInput) {
  const auto map = std::make_shared<SurfaceMap>(SurfaceMap::identity(3));
  EXPECT_THROW(StepLimiter(map, {.gap_floor = 0, .prescribed = {}, .groups = {}}), Error);
  EXPECT_THROW(StepLimiter(map, {.gap_floor = 1, .prescribed = {1}, .groups = {}}), Error);
  EXPECT_THROW(StepLimiter(map, {.gap_floor = 1, .kept_share = 1, .prescribed = {}, .groups = {}}), Error);
}

}  // namespace
}  // namespace muslin
