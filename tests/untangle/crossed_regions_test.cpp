// Contours cut surfaces into regions; those on the wrong side know their way back.
#include "muslin/untangle/crossed_regions.hpp"

#include <set>

#include "support/tangles.hpp"
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"
#include "muslin/untangle/tangle.hpp"

namespace muslin {
namespace {

using test::TangledScene;

/// The points on a wrong side at the start, of the model's points.
std::vector<LostPoint> wrong_points(const std::shared_ptr<const Model>& model) {
  return TangleFinder(model->contact).find(model->rest_positions, 1).wrong;
}

TEST(CrossedRegions, OfADentAreItsPointsAndThoseThatItCovers) {
  TangledScene scene;
  scene.sheet("shirt", 0.4, 40, [](double, double) { return 0.0; });
  scene.sheet("jacket", 0.4, 40, test::dent);
  const auto model = scene.build();
  std::set<int> expected;  // the jacket's below the shirt, and the shirt's above the jacket
  for (int p = 0; p < 41 * 41; ++p) {
    const Vec3& x = model->rest_positions[static_cast<std::size_t>(p)];
    if (test::dent(x.x(), x.z()) > 0) continue;
    expected.insert(p);
    expected.insert(p + 41 * 41);
  }
  std::set<int> found;
  for (const LostPoint& lost : wrong_points(model)) {
    found.insert(lost.point);
    EXPECT_NEAR(std::abs(lost.out.y()), 1, 0.15);
    EXPECT_EQ(lost.out.y() > 0, lost.point >= 41 * 41) << "the jacket goes up, the shirt down";
    EXPECT_LT(lost.depth, 0.00701);
  }
  EXPECT_EQ(found, expected);
}

TEST(CrossedRegions, OfALayerThatEndsInsideAnotherAreOnTheirSide) {
  // The lower sheet slants through a smaller one, whose border it passes on both sides.
  TangledScene scene;
  scene.sheet("low", 0.4, 40, [](double x, double) { return 0.005 - 0.05 * x; }, "layer = 1");
  scene.sheet("high", 0.3, 31, [](double, double) { return 0.0; }, "layer = 2");
  for (const LostPoint& lost : wrong_points(scene.build())) {
    if (lost.point >= 41 * 41) {
      EXPECT_GT(lost.out.y(), 0.9);  // of the upper sheet
    } else {
      EXPECT_LT(lost.out.y(), -0.9);
    }
  }
  EXPECT_GT(wrong_points(scene.build()).size(), 500U);
}

TEST(CrossedRegions, OfASheetThatABladeCutsAreNone) {
  TangledScene scene;
  scene.sheet("sheet", 0.5, 40, [](double, double) { return 0.0; });
  scene.sheet("blade", 0.25, 25, TangledScene::Place([](double x, double z) {
                return Vec3(x, z + 0.063 + 0.02 * x, 0.011 + 0.02 * x);
              }));
  const auto model = scene.build();
  std::size_t below = 0;
  for (std::size_t p = 41 * 41; p < model->rest_positions.size(); ++p)
    below += model->rest_positions[p].y() < 0 ? 1 : 0;
  const std::vector<LostPoint> lost = wrong_points(model);
  EXPECT_EQ(lost.size(), below);
  for (const LostPoint& l : lost) {
    EXPECT_GE(l.point, 41 * 41);
    EXPECT_LT((l.out - Vec3(0, 1, 0)).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace muslin
