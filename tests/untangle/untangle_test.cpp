// A tangle consists of piercings, insides of solids and separations, which are an energy.
#include "support/potential_battery.hpp"
#include "support/tangles.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/untangle/piercings.hpp"
#include "muslin/untangle/solid_insides.hpp"
#include "muslin/untangle/tangle.hpp"

namespace muslin {
namespace {

using test::TangledScene;

TEST(Piercings, AreWhereEdgesPassThroughTriangles) {
  const ContactSurface surface({{0, 1, 2}, {3, 4, 5}}, {0, 0, 0, 1, 1, 1}, {{}, {}});
  const std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.3, -1}, {0.2, 0.3, 3}, {5, 5, 3}};
  const std::vector<std::array<int, 2>> crossing = {{0, 1}};
  const std::vector<Piercing> found = find_piercings(surface, x, crossing);
  ASSERT_EQ(found.size(),
            2U);  // the upright edge through the first triangle, a side of it through the second
  EXPECT_EQ(found[0].triangle, 1);
  EXPECT_EQ(found[1].triangle, 0);
  EXPECT_LT((found[1].at - Vec3(0.2, 0.3, 0)).norm(), 1e-15);
  EXPECT_LT((found[1].barycentric - Vec3(0.5, 0.2, 0.3)).norm(), 1e-15);
  EXPECT_NEAR(found[1].along, 0.25, 1e-15);
}

TEST(SolidInsides, AreThePointsInsideWithTheNearestWayOut) {
  TangledScene scene;
  scene.sheet("cloth", 0.4, 20, [](double, double) { return 0.095; });
  scene.add("[[collider]]\nname = 'box'\nshape = 'box'\ncenter = [0, 0, 0]\nsize = [0.21, 0.2, 0.21]\n");
  const auto model = scene.build();
  const ContactModel& contact = *model->contact;
  std::vector<Vec3> x(contact.surface->point_count());
  contact.map->apply(model->rest_positions, x);
  const SurfacePieces pieces(*contact.surface, x);
  ASSERT_EQ(pieces.count(), 2);
  EXPECT_FALSE(pieces.is_solid(0));
  EXPECT_TRUE(pieces.is_solid(1));
  const std::vector<LostPoint> lost =
      find_solid_insides(*contact.surface, pieces, x, std::vector<std::array<int, 2>>{{0, 801}});
  EXPECT_EQ(lost.size(), 11U * 11U);  // |x|, |z| ≤ 0.1
  for (const LostPoint& l : lost) {
    EXPECT_EQ(l.piece, 1);
    EXPECT_NEAR(l.depth, 0.005, 1e-12);
    const Vec3 out = l.out;
    EXPECT_NEAR(std::max({out.y(), std::abs(out.x()), std::abs(out.z())}), 1, 1e-12);
  }
}

TEST(Separation, HasTheDerivativesOfItsEnergy) {
  const auto map = std::make_shared<const SurfaceMap>(
      5, std::vector<int>{0, 2, 3, 4, 5},
      std::vector<SurfaceMap::Entry>{{0, 0.4}, {1, 0.6}, {2, 1}, {3, 1}, {4, 1}});
  Separation apart, alone;
  apart.points = {0, 1, 2, 3};
  apart.weights = {1, -0.2, -0.3, -0.5};
  apart.normal = Vec3(1, 2, -2) / 3;
  apart.gap = 10;
  apart.stiffness = 70;
  alone.points[0] = 0;
  alone.weights[0] = 1;
  alone.normal = Vec3(0, 1, 0);
  alone.gap = 3;
  alone.stiffness = 20;
  const SeparationPotential potential(map, {apart, alone});
  const std::vector<Vec3> x = test::random_vectors(5, 1, 3);
  test::expect_gradient_matches_value(potential, x);
  test::expect_hessian_matches_gradient(potential, x);
  // Between surfaces it exerts no force in all, and beyond the gap none.
  std::vector<Vec3> g(5, Vec3::Zero());
  SeparationPotential(map, {apart}).add_gradient(x, g);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& force : g) sum += force;
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_GT(g[0].norm(), 1);
  apart.gap = -10;
  EXPECT_EQ(SeparationPotential(map, {apart}).value(x), 0);
}

TEST(WrongSides, CountWhatIsInsideThoughNothingCrosses) {
  TangledScene scene;
  scene.tube("sleeve", 0.3, 60, 24, [](double, double) { return 0.048; }, false);
  scene.tube("arm", 0.6, 40, 20, [](double, double) { return 0.05; }, true);
  const auto model = scene.build();
  const std::vector<WrongSide> sides = find_wrong_sides(model->contact, model->rest_positions);
  ASSERT_EQ(sides.size(), 1U);
  EXPECT_EQ(sides[0].points, 1500U);
  EXPECT_NEAR(sides[0].depth, 0.002, 3e-4);
  EXPECT_THAT(describe(*model->contact, sides[0]),
              testing::MatchesRegex("1500 points of \"sleeve\" are inside \"arm\", up to .* mm deep"));
}

}  // namespace
}  // namespace muslin
