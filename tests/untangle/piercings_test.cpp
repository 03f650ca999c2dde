// Edges pierce triangles at the corners of contours.
#include "muslin/untangle/piercings.hpp"

#include <gtest/gtest.h>

namespace muslin {
namespace {

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

}  // namespace
}  // namespace muslin
