// The energy turned over is what the scene brings into motion.
#include "muslin/report/energy_turnover.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace muslin {
namespace {

Diagnostics row(int frame, double kinetic, double elastic, double unbalanced) {
  Diagnostics d;
  d.frame = frame;
  d.kinetic = kinetic;
  d.elastic = elastic;
  d.unbalanced = unbalanced;
  return d;
}

TEST(EnergyTurnover, IsThatOfTheStartTheFallAndTheWork) {
  Diagnostics start = row(0, 4, 2, 0), end = row(1, 0, 1, 0);
  start.potential = 9, end.potential = 6, end.work = 5;
  EXPECT_DOUBLE_EQ(measure_turnover(std::vector{start, end}).turned_over, 4 + 1 + 3 + 5);
}

TEST(EnergyTurnover, DoesNotGrowAsAClothTrembles) {
  std::vector<Diagnostics> rows = {row(0, 4, 0, 0)};
  for (int frame = 1; frame < 100; ++frame)
    rows.push_back(frame % 2 == 0 ? row(frame, 4, 0, 0) : row(frame, 0, 4, 0));
  EXPECT_DOUBLE_EQ(measure_turnover(rows).turned_over, 4);
  EXPECT_DOUBLE_EQ(measure_turnover(rows).share(), 0);
}

TEST(EnergyTurnover, TellsWhatResidualsExplainFromWhatTheyDoNot) {
  const EnergyTurnover explained = measure_turnover(std::vector{row(0, 4, 0, 0), row(1, 0, 3.9, -0.1)});
  EXPECT_DOUBLE_EQ(explained.unbalanced, -0.1);
  EXPECT_EQ(explained.frame_of_unbalanced, 1);
  EXPECT_NEAR(explained.account_error, 0, 1e-15);
  EXPECT_NEAR(explained.share(), 0.1 / 4, 1e-12);
  const EnergyTurnover lost = measure_turnover(std::vector{row(0, 4, 0, 0), row(1, 0, 3, 0)});
  EXPECT_DOUBLE_EQ(lost.account_error, 1);
}

TEST(EnergyTurnover, IgnoresNoiseOfABodyAtRest) {
  const EnergyTurnover energy = measure_turnover(std::vector{row(0, 0, 7, 0), row(1, 1e-14, 7, 1e-14)});
  EXPECT_EQ(energy.share(), 0);
}

TEST(EnergyTurnover, OfNothingIsNothing) {
  EXPECT_EQ(measure_turnover({}).share(), 0);
  EXPECT_EQ(measure_turnover(std::vector{row(0, 0, 0, 0)}).share(), 0);
}

}  // namespace
}  // namespace muslin
