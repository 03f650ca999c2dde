#include "muslin/post/finish.hpp"

#include "geometry/shapes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/geometry/thicken.hpp"

namespace muslin {
namespace {

TEST(Finish, AppliesEveryStageInItsOrder) {
  const Mesh sheet = shapes::rectangle(1, 1, 4, 4);
  const Mesh dense = shapes::rectangle(1, 1, 16, 16);
  const Finish finish(sheet, {.smooth = 2, .subdivide = 1, .carried = dense, .thickness = 0.01});
  EXPECT_EQ(finish.mesh().face_count(), thicken(dense, 0.01).face_count());
  EXPECT_TRUE(is_closed(finish.mesh()));
  std::vector<Vec3> lifted = sheet.positions;
  for (Vec3& x : lifted) x.z() += 1;
  const Carried moved = finish.points(lifted);
  ASSERT_EQ(moved.points.size(), finish.mesh().vertex_count());
  for (std::size_t v = 0; v < moved.points.size(); ++v)
    EXPECT_NEAR((moved.points[v] - finish.mesh().positions[v] - Vec3::UnitZ()).norm(), 0, 1e-6);
}

TEST(Finish, AThickSheetHasTheVolumeOfItsAreaTimesItsThickness) {
  const Mesh sheet = shapes::rectangle(2, 1, 4, 4);
  EXPECT_NEAR(shapes::volume(Finish(sheet, {.thickness = 0.01}).mesh()), 0.02, 1e-12);
}

TEST(Finish, WithoutOptionsChangesNothing) {
  EXPECT_TRUE(FinishOptions{}.changes_nothing());
  const Mesh sheet = shapes::rectangle(1, 1, 4, 4);
  EXPECT_EQ(Finish(sheet, {}).points(sheet.positions).points, sheet.positions);
}

TEST(Finish, RefusesOptionsOutOfRange) {
  const Mesh sheet = shapes::rectangle(1, 1);
  EXPECT_THROW(Finish(sheet, {.smooth = -1}), Error);
  EXPECT_THROW(Finish(sheet, {.subdivide = 9}), Error);
  EXPECT_THROW(Finish(sheet, {.thickness = -1}), Error);
}

}  // namespace
}  // namespace muslin
