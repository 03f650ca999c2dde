#include "muslin/core/parallel.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace muslin {
namespace {

double harmonic(std::size_t count) {
  return parallel_sum(count, 1000, 0.0, [](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += 1.0 / static_cast<double>(i + 1);
    return sum;
  });
}

TEST(Parallel, SumHasTheSameBitsForAnyThreadCount) {
  set_thread_count(1);
  const double one = harmonic(123457);
  set_thread_count(2);
  EXPECT_EQ(one, harmonic(123457));
  set_thread_count(0);
  EXPECT_EQ(one, harmonic(123457));
  EXPECT_NEAR(one, std::log(123457.0) + 0.5772156649 + 0.5 / 123457, 1e-9);
}

TEST(Parallel, ForVisitsEveryIndexOnce) {
  for (std::size_t count : {0, 1, 999, 1000, 1001, 5432}) {
    std::vector<int> seen(count, 0);
    parallel_for(count, 1000, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++seen[i];
    });
    EXPECT_EQ(seen, std::vector<int>(count, 1));
  }
}

}  // namespace
}  // namespace muslin
