// Points inside solids know the nearest way out.
#include "muslin/untangle/solid_insides.hpp"

#include "support/tangles.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"

namespace muslin {
namespace {

using test::TangledScene;

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

}  // namespace
}  // namespace muslin
