// The guard's promise: whatever a solver asks for, what it is given crosses nothing, judged by exact
// predicates; however far things go, wherever they are stopped on the way.
#include "muslin/contact/contact_guard.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "support/draped_cloth.hpp"
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "muslin/contact/intersections.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

/// Crumpled cloth of n × n vertices, 1 m × 1 m, and a sheet beneath it that does not move.
struct Scene {
  std::shared_ptr<ContactModel> model = std::make_shared<ContactModel>();
  std::vector<Vec3> q;
  std::size_t cloth_size = 0;

  explicit Scene(int n) {
    const test::ClothGrid cloth = test::draped_cloth(n), flat(n, n, 1.0 / (n - 1)), floor(4, 4, 1);
    cloth_size = cloth.positions.size();
    q = cloth.positions;
    model->rest = flat.positions;
    std::vector<Vec3i> triangles = cloth.triangles;
    std::vector<int> bodies(cloth_size, 0);
    const Vec3 lowest(
        0,
        std::min_element(q.begin(), q.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); })->y(),
        0);
    for (const Vec3& p : floor.positions) {
      q.push_back(p - Vec3(1.5, 0.05, 1.5) + lowest);
      model->rest.push_back(q.back());
      bodies.push_back(1);
    }
    for (const Vec3i& t : floor.triangles) triangles.push_back(t.array() + static_cast<int>(cloth_size));
    model->surface = std::make_shared<ContactSurface>(triangles, bodies,
                                                      std::vector<ContactBody>{{}, {0.001, false, true}});
    model->map = std::make_shared<SurfaceMap>(SurfaceMap::identity(q.size()));
    model->distance = std::min(2e-3, 0.2 / (n - 1));
    model->limits.gap_floor = 0.005 * model->distance;
  }
  bool crosses() const {
    return !find_intersections(q, model->surface->triangles(), {.limit = 1, .wanted = {}}).empty();
  }
};

class FarWays : public ::testing::TestWithParam<int> {};

TEST_P(FarWays, NeverMakeCrumpledClothCross) {
  // All go along for several edges, some much less, one in twenty anywhere: most points get where they were
  // to go and the others are stopped on the way.
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  Scene scene(22);
  ASSERT_FALSE(scene.crosses());
  ContactMemory memory;
  ContactGuard guard(scene.model, memory);
  std::vector<std::uint8_t> held(scene.q.size(), 0);
  std::fill(held.begin() + static_cast<std::ptrdiff_t>(scene.cloth_size), held.end(), 1);
  const double edge = 1.0 / 21;
  std::normal_distribution<double> noise(0, 1);
  std::uniform_real_distribution<double> any(0, 1);
  double moved = 0;
  for (int step = 0; step < 12; ++step) {
    guard.begin(scene.q, held);
    const Vec3 along = 1.8 * edge * Vec3(noise(random), noise(random) - 0.5, noise(random)).normalized();
    for (int iteration = 0; iteration < 3; ++iteration) {
      std::vector<Vec3> d(scene.q.size(), Vec3::Zero());
      for (std::size_t v = 0; v < scene.cloth_size; ++v) {
        if (iteration == 0) d[v] = any(random) < 0.05 ? Vec3(0.1 * along) : along;
        const double size = any(random) < 0.05 ? edge : 0.02 * edge;
        d[v] += size * Vec3(noise(random), noise(random), noise(random));
      }
      guard.limit(scene.q, d);
      for (std::size_t v = 0; v < d.size(); ++v) {
        scene.q[v] += d[v];
        moved += d[v].norm() / static_cast<double>(scene.cloth_size);
      }
      ASSERT_FALSE(scene.crosses()) << "step " << step << ", iteration " << iteration;
      guard.potential(scene.q, StepGuard::Friction::anew);
    }
    guard.end(scene.q);
    ASSERT_GT(guard.memory().smallest_gap, 0);
  }
  EXPECT_GT(moved, 4 * edge);
  EXPECT_GT(guard.counts().deflected + guard.counts().shortened, 100U);
  EXPECT_GT(guard.counts().searches, guard.counts().limits);
}

/// A motion of the scene's cloth as one rigid group.
struct RigidWay {
  std::vector<std::uint8_t> held;
  std::vector<int> groups;
  std::vector<Vec3> d;

  RigidWay(const Scene& scene, const Vec3& along)
      : held(scene.q.size(), 1), groups(scene.q.size(), -1), d(scene.q.size(), Vec3::Zero()) {
    const Eigen::AngleAxisd turn(1e-3, Vec3::UnitY());
    for (std::size_t v = 0; v < scene.cloth_size; ++v) {
      held[v] = 0;
      groups[v] = 0;
      d[v] = turn * scene.q[v] - scene.q[v] + along;
    }
  }
};

TEST(RigidWays, AreNotLimitedFarFromOthers) {
  Scene scene(22);
  for (std::size_t v = 0; v < scene.cloth_size; ++v) scene.q[v].y() += 2;
  ContactMemory memory;
  ContactGuard guard(scene.model, memory);
  const RigidWay up(scene, Vec3(0, 0.3, 0));  // six edges
  guard.begin(scene.q, up.held);
  std::vector<Vec3> alone = up.d, together = up.d;
  guard.limit(scene.q, alone);
  EXPECT_NE(alone, up.d);
  guard.limit(scene.q, together, up.groups);
  EXPECT_EQ(together, up.d);
}

TEST(RigidWays, AreLimitedNearOthers) {
  Scene scene(22);
  ContactMemory memory;
  ContactGuard guard(scene.model, memory);
  RigidWay down(scene, Vec3(0, -0.08, 0));  // the sheet is 5 cm beneath
  guard.begin(scene.q, down.held);
  Scene crossed = scene;
  for (std::size_t v = 0; v < down.d.size(); ++v) crossed.q[v] += down.d[v];
  EXPECT_TRUE(crossed.crosses());
  guard.limit(scene.q, down.d, down.groups);
  for (std::size_t v = 0; v < down.d.size(); ++v) scene.q[v] += down.d[v];
  EXPECT_FALSE(scene.crosses());
}

INSTANTIATE_TEST_SUITE_P(Seeds, FarWays, ::testing::Range(1, 6));

}  // namespace
}  // namespace muslin
