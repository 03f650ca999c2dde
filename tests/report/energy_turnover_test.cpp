// The energy turned over counts every joule that changes its account once.
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

TEST(EnergyTurnover, CountsAnOscillationTwiceAPeriod) {
  const EnergyTurnover energy =
      measure_turnover(std::vector{row(0, 4, 0, 0), row(1, 0, 4, 0), row(2, 4, 0, 0)});
  EXPECT_DOUBLE_EQ(energy.turned_over, 8);
  EXPECT_DOUBLE_EQ(energy.share(), 0);
}

TEST(EnergyTurnover, TellsWhatResidualsExplainFromWhatTheyDoNot) {
  const EnergyTurnover explained = measure_turnover(std::vector{row(0, 4, 0, 0), row(1, 0, 3.9, -0.1)});
  EXPECT_DOUBLE_EQ(explained.unbalanced, -0.1);
  EXPECT_EQ(explained.frame_of_unbalanced, 1);
  EXPECT_NEAR(explained.account_error, 0, 1e-15);
  EXPECT_NEAR(explained.share(), 0.1 / 3.95, 1e-12);
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
