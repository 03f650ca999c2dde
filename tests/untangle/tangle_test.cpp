// A tangle tells what is on a wrong side.
#include "muslin/untangle/tangle.hpp"

#include "support/tangles.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/contact/contact_model.hpp"

namespace muslin {
namespace {

using test::TangledScene;

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
