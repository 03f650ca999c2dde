// Distances of pairs: what is said of a pair without looking is never more than its distance, what is near is
// known, and what does not change is not looked at again.
#include "muslin/contact/pair_distances.hpp"

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "support/distances_at.hpp"
#include "support/draped_cloth.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

struct Crumpled {
  std::vector<Vec3> x;
  std::shared_ptr<ContactSurface> surface;
  ContactCandidates candidates;

  explicit Crumpled(const test::ClothGrid& cloth)
      : x(cloth.positions),
        surface(std::make_shared<ContactSurface>(cloth.triangles, std::vector<int>(x.size(), 0),
                                                 std::vector<ContactBody>{{0.0002, true, false}})),
        candidates(surface, test::ClothGrid(cloth.columns, cloth.rows, 1.0 / (cloth.columns - 1)).positions,
                   2e-3) {}
};

TEST(PairDistances, AreLowerBoundsAndExactForNearPairs) {
  Crumpled cloth(test::draped_cloth(30));
  // Far from the origin and all together far along, so that only ways relative to each other tell.
  for (Vec3& p : cloth.x) p += Vec3(3, -2, 1);
  cloth.candidates.update(cloth.x, cloth.x, 4e-3);
  PairDistances distances(cloth.candidates);
  std::size_t unknown = 0;
  for (int k = 0; k < 5; ++k) {
    std::vector<Vec3> moved = cloth.x;
    const std::vector<Vec3> noise = test::random_vectors(moved.size(), 4e-4 * k, static_cast<unsigned>(k));
    for (std::size_t p = 0; p < moved.size(); ++p) moved[p] += Vec3(0.02, 0.03, 0) * k + noise[p];
    distances.update(moved);
    for (std::size_t i = 0; i < cloth.candidates.pairs().size(); ++i) {
      const ContactPair& pair = cloth.candidates.pairs()[i];
      const double distance = pair_geometry(*cloth.surface, pair, moved).distance;
      ASSERT_LE(distances[i].distance, distance) << k;
      if (distance - pair.thickness < 3e-3) {
        ASSERT_TRUE(distances.is_known(i)) << k;
        ASSERT_EQ(distances[i].distance, distance);
      }
      unknown += distances.is_known(i) ? 0 : 1;
    }
  }
  EXPECT_GT(unknown, cloth.candidates.pairs().size()) << "bounds hardly ever tell that a pair is far";
}

TEST(PairDistances, FindComputesUnknownPairs) {
  Crumpled cloth(test::draped_cloth(12));
  cloth.candidates.update(cloth.x, cloth.x, 0.05);
  PairDistances distances = test::distances_at(cloth.candidates, cloth.x);
  std::size_t found = 0;
  for (std::size_t i = 0; i < cloth.candidates.pairs().size(); ++i) {
    if (distances.is_known(i)) continue;
    ++found;
    EXPECT_EQ(distances.find(i).distance,
              pair_geometry(*cloth.surface, cloth.candidates.pairs()[i], cloth.x).distance);
    EXPECT_TRUE(distances.is_known(i));
  }
  EXPECT_GT(found, 0U);
}

TEST(PairDistances, FollowThePointsAndTheCandidates) {
  Crumpled cloth(test::draped_cloth(12));
  cloth.candidates.update(cloth.x, cloth.x, 0.05);
  PairDistances distances = test::distances_at(cloth.candidates, cloth.x);
  const auto closest = [&] {
    double least = 1;
    for (std::size_t i = 0; i < cloth.candidates.pairs().size(); ++i)
      least = std::min(least, distances.find(i).distance);
    return least;
  };
  const double before = closest();
  std::vector<Vec3> larger = cloth.x;
  for (Vec3& p : larger) p *= 1.1;
  distances.update(larger);
  EXPECT_NE(closest(), before);
  cloth.candidates.update(larger, larger, 0.06);
  distances.forget();
  distances.update(larger);
  for (std::size_t i = 0; i < cloth.candidates.pairs().size(); ++i)
    ASSERT_LE(distances[i].distance,
              pair_geometry(*cloth.surface, cloth.candidates.pairs()[i], larger).distance);
  EXPECT_THROW(distances.update(std::vector<Vec3>(3, Vec3::Zero())), Error);
}

}  // namespace
}  // namespace muslin
