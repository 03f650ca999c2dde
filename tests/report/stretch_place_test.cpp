// The place of the largest stretch is that of the triangle or spring that was stretched, by its principal
// stretch.
#include "muslin/report/stretch_place.hpp"

#include <cmath>

#include "report/falling_sheet.hpp"
#include <gtest/gtest.h>

namespace muslin {
namespace {

using test::Scratch;

/// The cached sheet, mapped by x' = a x and z' = b z about its centre.
void scale(const std::filesystem::path& run, int frame, float a, float b) {
  test::move_points(run / "sheet.skin.pc2", frame, [a, b](std::vector<Vec3f>& points) {
    for (Vec3f& p : points) p = Vec3f(a * p[0], p[1], b * p[2]);
  });
}

TEST(StretchPlace, IsThePrincipalStretchOfASheet) {
  const Scratch scratch;
  const std::filesystem::path run = test::run_sheet(scratch, "[[force]]\ntype = \"gravity\"\n");
  scale(run, 2, 1.25F, 0.5F);
  const std::optional<StretchPlace> place = find_largest_stretch(RunReader(run), 2);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->ratio, 1.25, 1e-4);
  EXPECT_EQ(place->body, "sheet");
}

TEST(StretchPlace, IsWhereACornerWasPulled) {
  const Scratch scratch;
  const std::filesystem::path run = test::run_sheet(scratch, "[[force]]\ntype = \"gravity\"\n");
  test::move_points(run / "sheet.skin.pc2", 3,
                    [](std::vector<Vec3f>& points) { points[0] += Vec3f(-0.1F, 0, -0.1F); });
  const std::optional<StretchPlace> place = find_largest_stretch(RunReader(run), 3);
  ASSERT_TRUE(place);
  // A diagonal of the square starts at this corner: the deformation gradients of both triangles are [1 1; 0
  // 2], up to an exchange of axes.
  EXPECT_NEAR(place->ratio, std::sqrt(3 + std::sqrt(5.0)), 1e-3);
  EXPECT_LT(place->at.x(), -0.2);
  EXPECT_LT(place->at.z(), -0.2);
}

TEST(StretchPlace, IsOneAtTheStart) {
  const Scratch scratch;
  const std::filesystem::path run = test::run_sheet(scratch);
  const std::optional<StretchPlace> place = find_largest_stretch(RunReader(run), 0);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->ratio, 1, 1e-12);
}

}  // namespace
}  // namespace muslin
