// The broad phase against trying every pair of features.
#include "muslin/contact/pair_search.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "support/cloth_grid.hpp"
#include "support/distances_at.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/contact/distance.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

/// Crumpled cloth, a segment and two lone points, each a body.
struct Scene {
  std::vector<Vec3> positions;
  std::shared_ptr<const ContactSurface> surface;

  explicit Scene(bool self_contact = true, double crumple = 0.1) {
    const test::ClothGrid cloth(11, 12, 0.1);
    positions = cloth.positions;
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> noise(-crumple, crumple);
    for (Vec3& p : positions) p += Vec3(noise(random), noise(random), noise(random));
    std::vector<Vec3i> triangles = cloth.triangles;
    std::vector<int> bodies(positions.size(), 0);
    const int n = static_cast<int>(positions.size());
    for (const Vec3& p : {Vec3(0.1, 0.1, 0.1), Vec3(0.8, 0.2, 0.9), Vec3(0.5, 0.3, 0.5), Vec3(0.5, 0.7, 0.6)})
      positions.push_back(p);
    triangles.emplace_back(n, n + 1, n + 1);
    triangles.emplace_back(n + 2, n + 2, n + 2);
    triangles.emplace_back(n + 3, n + 3, n + 3);
    for (const int body : {1, 1, 2, 3}) bodies.push_back(body);
    surface = std::make_shared<ContactSurface>(
        triangles, bodies,
        std::vector<ContactBody>{
            {0, self_contact, false}, {0.05, true, true}, {0.2, true, true}, {0.25, true, false}});
  }

  std::array<Vec3, 4> points(const VertexTriangle& pair) const {
    const Vec3i& t = surface->triangles()[static_cast<std::size_t>(pair.triangle)];
    return {at(pair.point), at(t[0]), at(t[1]), at(t[2])};
  }
  std::array<Vec3, 4> points(const EdgeEdge& pair) const {
    const auto& e = surface->edges()[static_cast<std::size_t>(pair.first)];
    const auto& f = surface->edges()[static_cast<std::size_t>(pair.second)];
    return {at(e[0]), at(e[1]), at(f[0]), at(f[1])};
  }
  const Vec3& at(int p) const { return positions[static_cast<std::size_t>(p)]; }
};

template <class Pair>
bool contains_once(const std::vector<Pair>& sorted, const Pair& pair) {
  const auto [begin, end] = std::equal_range(sorted.begin(), sorted.end(), pair);
  return end - begin == 1;
}

/// Boxes around ways, or that go along them.
MovingBoxes boxes_along(ConstVectors from, ConstVectors to, bool moving) {
  MovingBoxes boxes(from.size());
  for (std::size_t p = 0; p < from.size(); ++p) {
    if (moving) {
      boxes.move(p, from[p], to[p], 0);
    } else {
      boxes.stay(p, from[p], to[p], 0);
    }
  }
  return boxes;
}
MovingBoxes boxes_at(ConstVectors x) { return boxes_along(x, x, false); }

FeaturePairs sorted(FeaturePairs found) {
  std::sort(found.vertex_triangle.begin(), found.vertex_triangle.end());
  std::sort(found.edge_edge.begin(), found.edge_edge.end());
  return found;
}

FeaturePairs sorted_pairs(const Scene& scene, const MovingBoxes& boxes, double reach) {
  PairSearch search(scene.surface, scene.positions);
  FeaturePairs found;
  search.find(boxes, reach, found);
  return sorted(std::move(found));
}

TEST(PairSearch, FindsEveryPairWithinReachOnce) {
  const Scene scene;
  const ContactSurface& surface = *scene.surface;
  const double reach = 0.06;
  const FeaturePairs found = sorted_pairs(scene, boxes_at(scene.positions), reach);
  EXPECT_EQ(std::adjacent_find(found.vertex_triangle.begin(), found.vertex_triangle.end()),
            found.vertex_triangle.end());
  EXPECT_EQ(std::adjacent_find(found.edge_edge.begin(), found.edge_edge.end()), found.edge_edge.end());
  int close = 0;
  for (int p = 0; p < static_cast<int>(surface.point_count()); ++p) {
    for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t) {
      const Vec3i& c = surface.triangles()[static_cast<std::size_t>(t)];
      if ((c.array() == p).any() || !surface.may_touch(surface.body_of(p), surface.body_of(c[0]))) continue;
      if (c[0] == c[2] && surface.body_of(p) < 2) continue;  // the lone point's own pair says it
      const VertexTriangle pair = {p, t};
      const double gap = closest_points(PairKind::vertex_triangle, scene.points(pair)).distance() -
                         surface.radius_of(p) - surface.radius_of(c[0]);
      if (gap > reach) continue;
      ++close;
      EXPECT_TRUE(contains_once(found.vertex_triangle, pair)) << p << " " << t;
    }
  }
  for (int e = 0; e < static_cast<int>(surface.edges().size()); ++e) {
    for (int f = e + 1; f < static_cast<int>(surface.edges().size()); ++f) {
      const auto &a = surface.edges()[static_cast<std::size_t>(e)],
                 &b = surface.edges()[static_cast<std::size_t>(f)];
      if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
      const double gap = closest_points(PairKind::edge_edge, scene.points(EdgeEdge{e, f})).distance() -
                         surface.radius_of(a[0]) - surface.radius_of(b[0]);
      if (gap > reach) continue;
      ++close;
      EXPECT_TRUE(contains_once(found.edge_edge, {e, f})) << e << " " << f;
    }
  }
  EXPECT_GT(close, 400);
  for (const VertexTriangle& pair : found.vertex_triangle) {
    const Vec3i& c = surface.triangles()[static_cast<std::size_t>(pair.triangle)];
    EXPECT_FALSE((c.array() == pair.point).any());
    EXPECT_TRUE(surface.may_touch(surface.body_of(pair.point), surface.body_of(c[0])));
  }
}

TEST(PairSearch, CoversMotion) {
  // Whatever is close at any time on the way is found, in boxes around ways and in boxes that go along them.
  const Scene scene;
  std::vector<Vec3> after = scene.positions;
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> noise(-0.2, 0.2);
  for (Vec3& p : after) p += Vec3(noise(random), noise(random), noise(random));
  const double reach = 0.01;
  std::size_t most = 0;
  for (const bool moving : {false, true}) {
    const FeaturePairs swept = sorted_pairs(scene, boxes_along(scene.positions, after, moving), reach);
    if (moving) {
      EXPECT_LT(swept.edge_edge.size(), most);
    }
    most = swept.edge_edge.size();
    Scene between = scene;
    for (const double t : {0.0, 0.3, 0.7, 1.0}) {
      for (std::size_t p = 0; p < after.size(); ++p)
        between.positions[p] = (1 - t) * scene.positions[p] + t * after[p];
      const FeaturePairs now = sorted_pairs(between, boxes_at(between.positions), reach);
      for (const VertexTriangle& pair : now.vertex_triangle) {
        if (closest_points(PairKind::vertex_triangle, between.points(pair)).distance() > reach) continue;
        EXPECT_TRUE(contains_once(swept.vertex_triangle, pair));
      }
      for (const EdgeEdge& pair : now.edge_edge) {
        if (closest_points(PairKind::edge_edge, between.points(pair)).distance() > reach) continue;
        EXPECT_TRUE(contains_once(swept.edge_edge, pair));
      }
    }
  }
}

TEST(PairSearch, FindsNoAdditionalPairsInUniformMotion) {
  // Slanted cloth that goes ten edges far as a whole is as far from itself as cloth at rest.
  const Scene scene(true, 0);
  std::vector<Vec3> from = scene.positions, after = from;
  for (Vec3& p : from) p += Vec3(0, p.x() + p.z(), 0);
  for (std::size_t p = 0; p < from.size(); ++p) after[p] = from[p] + Vec3(0.6, 0.7, 0.5);
  const std::size_t still = sorted_pairs(scene, boxes_at(from), 0.01).edge_edge.size(),
                    along = sorted_pairs(scene, boxes_along(from, after, true), 0.01).edge_edge.size(),
                    around = sorted_pairs(scene, boxes_along(from, after, false), 0.01).edge_edge.size();
  EXPECT_LE(along, still + still / 10);
  EXPECT_GT(around, 5 * still);
}

TEST(PairSearch, FindsOnlyThePairsOfMovedPoints) {
  const Scene scene;
  const double reach = 0.06;
  std::vector<std::uint8_t> moved(scene.positions.size(), 0);
  for (const std::size_t p : {3, 40, 41, 100}) moved.at(p) = 1;
  moved.back() = 1;
  // Those that moved are found where they are now, the others where they were.
  std::vector<Vec3> before = scene.positions;
  for (std::size_t p = 0; p < moved.size(); ++p)
    if (moved[p] != 0) before[p] += Vec3(0.3, 0.1, -0.2);
  PairSearch search(scene.surface, scene.positions);
  FeaturePairs some;
  search.find(boxes_at(before), reach, some);
  search.find(boxes_at(scene.positions), reach, some, moved);
  some = sorted(std::move(some));
  const FeaturePairs all = sorted_pairs(scene, boxes_at(scene.positions), reach);
  const auto has_moved = [&](int p) { return moved[static_cast<std::size_t>(p)] != 0; };
  FeaturePairs expected;
  for (const VertexTriangle& pair : all.vertex_triangle) {
    const Vec3i& t = scene.surface->triangles()[static_cast<std::size_t>(pair.triangle)];
    if (has_moved(pair.point) || has_moved(t[0]) || has_moved(t[1]) || has_moved(t[2]))
      expected.vertex_triangle.push_back(pair);
  }
  for (const EdgeEdge& pair : all.edge_edge) {
    const auto& e = scene.surface->edges()[static_cast<std::size_t>(pair.first)];
    const auto& f = scene.surface->edges()[static_cast<std::size_t>(pair.second)];
    if (has_moved(e[0]) || has_moved(e[1]) || has_moved(f[0]) || has_moved(f[1]))
      expected.edge_edge.push_back(pair);
  }
  EXPECT_GT(expected.edge_edge.size(), 10);
  EXPECT_LT(expected.edge_edge.size(), all.edge_edge.size() / 3);
  EXPECT_EQ(some.vertex_triangle, expected.vertex_triangle);
  EXPECT_EQ(some.edge_edge, expected.edge_edge);
}

TEST(PairSearch, ExcludesSelfContactIfDisabled) {
  const Scene scene(false);
  const FeaturePairs found = sorted_pairs(scene, boxes_at(scene.positions), 0.03);
  EXPECT_FALSE(found.vertex_triangle.empty());
  for (const VertexTriangle& pair : found.vertex_triangle) {
    const int other = scene.surface->triangles()[static_cast<std::size_t>(pair.triangle)][0];
    EXPECT_NE(scene.surface->body_of(pair.point), scene.surface->body_of(other));
  }
}

TEST(PairSearch, FindsFewPairsInFlatCloth) {
  const Scene flat(true, 0);
  const FeaturePairs found = sorted_pairs(flat, boxes_at(flat.positions), 0.002);
  EXPECT_LT(found.edge_edge.size(), 8 * flat.surface->edges().size());
}

TEST(PairSearch, KeepsItsOrderForAnyThreadCount) {
  const Scene scene;
  PairSearch search(scene.surface, scene.positions);
  FeaturePairs many, one;
  search.find(boxes_at(scene.positions), 0.05, many);
  set_thread_count(1);
  search.find(boxes_at(scene.positions), 0.05, one);
  set_thread_count(0);
  EXPECT_EQ(many.vertex_triangle, one.vertex_triangle);
  EXPECT_EQ(many.edge_edge, one.edge_edge);
}

TEST(ContactCandidates, ThickClothOnAFineMeshIsNotInContactAtRest) {
  // 8 mm thick, 2 mm range, 5 mm edges, under a ball of 1 m: what is close at rest is left out, what comes
  // close by folding is not, and the ball's size does not matter.
  const test::ClothGrid cloth(12, 12, 0.005);
  std::vector<Vec3> rest = cloth.positions;
  rest.push_back(Vec3(0, 1.1, 0));
  std::vector<Vec3i> triangles = cloth.triangles;
  triangles.emplace_back(144, 144, 144);
  std::vector<int> bodies(144, 0);
  bodies.push_back(1);
  const auto surface = std::make_shared<ContactSurface>(
      triangles, bodies, std::vector<ContactBody>{{0.004, true, false}, {1, true, false}});
  ContactCandidates candidates(surface, rest, 0.002);
  candidates.update(rest, rest, 2e-3);
  ASSERT_FALSE(candidates.pairs().empty());
  for (const ContactPair& pair : candidates.pairs()) {
    const double gap = pair_geometry(*surface, pair, rest).distance - pair.thickness;
    EXPECT_GT(gap, pair.range);
  }
  std::vector<Vec3> folded = rest;
  for (std::size_t v = 0; v < 144; ++v)
    if (rest[v].x() > 0.026) folded[v] = Vec3(0.052 - rest[v].x(), 0.009, rest[v].z());
  candidates.update(folded, folded, 1e-4);
  EXPECT_NEAR(test::distances_at(candidates, folded).smallest_gap(), 0.001, 1e-3);
  EXPECT_TRUE(std::any_of(candidates.pairs().begin(), candidates.pairs().end(),
                          [](const ContactPair& pair) { return pair.thickness == 0.008; }));
}

TEST(ContactCandidates, AreCompleteAfterRenewalOfSomePoints) {
  // A few points move far beyond their boxes, the others stay within theirs: whatever is in range then is a
  // candidate, once, and what is said of its distance holds.
  const Scene scene;
  const double range = 0.02, margin = 0.005;
  ContactCandidates candidates(scene.surface, scene.positions, range);
  candidates.update(scene.positions, scene.positions, margin);
  Scene now = scene;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> little(-margin, margin), far(-0.15, 0.15);
  std::vector<std::uint8_t> moved(scene.positions.size(), 0);
  for (std::size_t p = 0; p < moved.size(); ++p) {
    moved[p] = p % 9 == 0 ? 1 : 0;
    for (int k = 0; k < 3; ++k) now.positions[p][k] += moved[p] != 0 ? far(random) : little(random);
  }
  const std::size_t before = candidates.pairs().size();
  candidates.renew(moved, scene.positions, now.positions, margin);
  EXPECT_NE(candidates.pairs().size(), before);
  std::vector<std::uint64_t> keys;
  for (const ContactPair& pair : candidates.pairs()) keys.push_back(pair.key());
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
  ASSERT_EQ(candidates.least_distances().size(), candidates.pairs().size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const double distance =
        pair_geometry(*scene.surface, candidates.pairs()[i], candidates.found_at()).distance;
    EXPECT_LE(candidates.least_distances()[i], distance + 1e-6);
  }

  ContactCandidates fresh(scene.surface, scene.positions, range);
  fresh.update(now.positions, now.positions, 0);
  int close = 0;
  for (const ContactPair& pair : fresh.pairs()) {
    if (pair_geometry(*scene.surface, pair, now.positions).distance > pair.thickness + pair.range) continue;
    ++close;
    EXPECT_TRUE(std::binary_search(keys.begin(), keys.end(), pair.key()));
  }
  EXPECT_GT(close, 50);
}

TEST(ContactCandidates, AreCompleteForLinearMotionOfAllPoints) {
  // Far ways, some of which end short of where they were to go and are found anew: whatever is in range on
  // the way is a candidate.
  const Scene scene;
  const double range = 0.02, margin = 0.01;
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> noise(-0.15, 0.15), little(-margin, margin);
  std::vector<Vec3> there = scene.positions, stopped;
  for (Vec3& p : there) p += Vec3(noise(random), noise(random) + 0.2, noise(random));
  stopped = there;
  std::vector<std::uint8_t> moved(there.size(), 0);
  for (std::size_t p = 0; p < there.size(); p += 7) {
    stopped[p] = scene.positions[p] + 0.3 * (there[p] - scene.positions[p]);
    moved[p] = 1;
  }
  ContactCandidates candidates(scene.surface, scene.positions, range),
      fresh(scene.surface, scene.positions, range);
  candidates.update(scene.positions, there, margin, 0.1);
  EXPECT_TRUE(candidates.boxes().moving());
  const std::size_t unstopped = candidates.pairs().size();
  candidates.renew(moved, scene.positions, stopped, margin);
  EXPECT_GT(candidates.pairs().size(), unstopped);
  std::vector<std::uint64_t> keys;
  for (const ContactPair& pair : candidates.pairs()) keys.push_back(pair.key());
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
  int close = 0;
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    std::vector<Vec3> now = scene.positions;
    for (std::size_t p = 0; p < now.size(); ++p)
      for (int k = 0; k < 3; ++k) now[p][k] += t * (stopped[p][k] - scene.positions[p][k]) + little(random);
    fresh.update(now, now, 0);
    for (const ContactPair& pair : fresh.pairs()) {
      if (pair_geometry(*scene.surface, pair, now).distance > pair.thickness + pair.range) continue;
      ++close;
      EXPECT_TRUE(std::binary_search(keys.begin(), keys.end(), pair.key()));
    }
  }
  EXPECT_GT(close, 250);
}

TEST(ContactSurface, OwnsEachFeatureOnce) {
  const Scene scene;
  std::vector<int> points(scene.surface->point_count()), edges(scene.surface->edges().size());
  for (std::size_t t = 0; t < scene.surface->triangles().size(); ++t) {
    const auto own = scene.surface->ownership()[t];
    for (int i = 0; i < 3; ++i) {
      if ((own.vertices >> i & 1) != 0) ++points[static_cast<std::size_t>(scene.surface->triangles()[t][i])];
      if ((own.edges >> i & 1) != 0) ++edges[static_cast<std::size_t>(scene.surface->triangle_edges()[t][i])];
    }
  }
  EXPECT_EQ(std::count(points.begin(), points.end(), 1), static_cast<std::ptrdiff_t>(points.size()));
  EXPECT_EQ(std::count(edges.begin(), edges.end(), 1), static_cast<std::ptrdiff_t>(edges.size()));
  // 11 × 12 grid: 10·12 + 11·11 + 10·11 edges, and the segment.
  EXPECT_EQ(edges.size(), 120U + 121U + 110U + 1U);
  EXPECT_EQ(scene.surface->triangles_at_edge(static_cast<int>(edges.size()) - 1).size(), 1U);
}

TEST(ContactSurface, RefusesInvalidInput) {
  EXPECT_THROW(ContactSurface({{0, 1, 3}}, {0, 0, 0}, {{}}), Error);
  EXPECT_THROW(ContactSurface({{0, 1, 2}}, {0, 0, 1}, {{}, {}}), Error);
  EXPECT_THROW(ContactSurface({{0, 1, 2}}, {0, 0, 1}, {{}}), Error);
  EXPECT_THROW(ContactSurface({{0, 1, 2}}, {0, 0, 0}, {{-1, true, false}}), Error);
}

}  // namespace
}  // namespace muslin
