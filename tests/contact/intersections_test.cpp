// Crossing triangles of whole surfaces, against trying every pair.
#include "muslin/contact/intersections.hpp"

#include <cmath>
#include <random>

#include "support/cloth_grid.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/exact_predicates.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

TEST(FindIntersections, FindsNoneInFlatTurnedAndCurvedCloth) {
  test::ClothGrid cloth(12, 9, 0.1);
  EXPECT_TRUE(find_intersections(cloth.positions, cloth.triangles).empty());
  for (Vec3& p : cloth.positions) p = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * p;
  EXPECT_TRUE(find_intersections(cloth.positions, cloth.triangles).empty());
  for (Vec3& p : cloth.positions) p.y() += 0.1 * std::sin(9 * p.x()) * std::cos(7 * p.z());
  EXPECT_TRUE(find_intersections(cloth.positions, cloth.triangles).empty());
}

TEST(FindIntersections, AgreesWithBruteForceOnACrumpledSheet) {
  test::ClothGrid cloth(14, 14, 0.1);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> noise(-0.12, 0.12);
  for (Vec3& p : cloth.positions) p += Vec3(noise(random), noise(random), noise(random));
  const auto found = find_intersections(cloth.positions, cloth.triangles);
  std::size_t expected = 0;
  const auto corner = [&](std::size_t t, int i) -> const Vec3& {
    return cloth.positions[static_cast<std::size_t>(cloth.triangles[t][i])];
  };
  for (std::size_t a = 0; a < cloth.triangles.size(); ++a) {
    for (std::size_t b = a + 1; b < cloth.triangles.size(); ++b) {
      bool apart = true;
      for (const int v : cloth.triangles[a]) apart &= !(cloth.triangles[b].array() == v).any();
      const bool meet = triangles_meet({corner(a, 0), corner(a, 1), corner(a, 2)},
                                       {corner(b, 0), corner(b, 1), corner(b, 2)});
      if (apart && meet) ++expected;
      if (!meet || !apart) continue;
      const auto is_it = [&](const Intersection& i) {
        return static_cast<std::size_t>(i.first) == a && static_cast<std::size_t>(i.second) == b;
      };
      EXPECT_EQ(std::count_if(found.begin(), found.end(), is_it), 1);
    }
  }
  EXPECT_GT(expected, 20U);
  EXPECT_GE(found.size(), expected);
  for (const Intersection& i : found) EXPECT_TRUE(i.at.allFinite());
}

TEST(FindIntersections, ReportsThePlace) {
  const std::vector<Vec3> positions = {{0, 0, 0},      {1, 0, 0},     {0, 1, 0},
                                       {0.2, 0.2, -1}, {0.2, 0.3, 1}, {5, 5, 1}};
  const std::vector<Vec3i> triangles = {{0, 1, 2}, {3, 4, 5}};
  const auto found = find_intersections(positions, triangles);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].first, 0);
  EXPECT_EQ(found[0].second, 1);
  EXPECT_LT(std::fabs(found[0].at.z()), 1e-12);
  EXPECT_LT((found[0].at - Vec3(0.2, 0.25, 0)).norm(), 0.5);
}

TEST(FindIntersections, HandlesFoldsDuplicatesSegmentsAndPoints) {
  const std::vector<Vec3> positions = {{0, 0, 0},      {1, 0, 0},     {0, 1, 0},    {1, 0.1, 0},
                                       {0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.1, 0.1, 0}};
  const auto pairs = [&](std::vector<Vec3i> triangles) {
    return find_intersections(positions, triangles).size();
  };
  EXPECT_EQ(pairs({{0, 1, 2}, {1, 0, 3}}), 1U);  // folded flat
  EXPECT_EQ(pairs({{0, 1, 2}, {1, 2, 0}}), 1U);  // twice the same
  EXPECT_EQ(pairs({{0, 1, 2}, {4, 5, 5}}), 1U);  // a pole
  EXPECT_EQ(pairs({{0, 1, 2}, {6, 6, 6}}), 1U);  // a point
  EXPECT_EQ(pairs({{0, 1, 2}, {4, 4, 4}}), 0U);
  EXPECT_EQ(pairs({{0, 1, 2}, {0, 4, 4}}), 0U);  // a thread sewn on
}

TEST(FindIntersections, IsTheSameForAnyThreadCountAndStopsAtTheLimit) {
  test::ClothGrid cloth(30, 30, 0.1);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> noise(-0.15, 0.15);
  for (Vec3& p : cloth.positions) p += Vec3(noise(random), noise(random), noise(random));
  const auto all = find_intersections(cloth.positions, cloth.triangles);
  set_thread_count(1);
  const auto one = find_intersections(cloth.positions, cloth.triangles);
  set_thread_count(0);
  ASSERT_EQ(all.size(), one.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].first, one[i].first);
    EXPECT_EQ(all[i].second, one[i].second);
    EXPECT_EQ(all[i].at, one[i].at);
  }
  const auto few = find_intersections(cloth.positions, cloth.triangles, {.limit = 3, .wanted = {}});
  ASSERT_EQ(few.size(), 3U);
  EXPECT_EQ(few[2].second, all[2].second);
  const auto none = find_intersections(cloth.positions, cloth.triangles,
                                       {.limit = 10, .wanted = [](int, int) { return false; }});
  EXPECT_TRUE(none.empty());
}

TEST(FindIntersections, RefusesInvalidInput) {
  const std::vector<Vec3i> triangles = {{0, 1, 2}};
  EXPECT_THROW(find_intersections(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}, triangles), Error);
  EXPECT_THROW(find_intersections(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {NAN, 0, 0}}, triangles), Error);
  EXPECT_TRUE(find_intersections({}, {}).empty());
}

}  // namespace
}  // namespace muslin
