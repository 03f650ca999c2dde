// Parts of long work.
#include "muslin/core/progress_part.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

TEST(ProgressPart, ReportsItsShareOfTheWhole) {
  std::vector<std::pair<double, std::string>> reports;
  Progress whole;
  whole.report = [&](double fraction, std::string_view stage) { reports.emplace_back(fraction, stage); };
  const Progress part = progress_part(whole, 0.5, 0.75);
  part.at(0, "begin");
  part.at(1, "end");
  EXPECT_EQ(reports, (std::vector<std::pair<double, std::string>>{{0.5, "begin"}, {0.75, "end"}}));
}

TEST(ProgressPart, IsCancelledWithTheWhole) {
  bool stop = false;
  Progress whole;
  whole.cancelled = [&] { return stop; };
  const Progress part = progress_part(whole, 0, 0.5);
  part.at(0.5, "first");
  stop = true;
  EXPECT_THROW(part.at(0.6, "second"), Error);
}

TEST(ProgressPart, OfSilentWorkIsSilent) { EXPECT_FALSE(progress_part({}, 0, 1).report); }

}  // namespace
}  // namespace muslin
