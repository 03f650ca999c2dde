#include "muslin/solver/part_sums.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace muslin {
namespace {

struct Sums {
  double sum = 0, largest = 0;
  int count = 0;
  void operator+=(const Sums& other) {
    sum += other.sum, largest = std::max(largest, other.largest), count += other.count;
  }
  bool operator==(const Sums&) const = default;
};

std::vector<Sums> sums_of(std::size_t count, std::size_t parts) {
  return sum_by_part<Sums>(
      count, parts, [&](std::size_t v) { return (v * v) % parts; },
      [](Sums& sums, std::size_t v) {
        const double value = std::sin(static_cast<double>(v));
        sums.sum += value, sums.largest = std::max(sums.largest, value), ++sums.count;
      });
}

TEST(SumByPart, AddsEveryVertexToItsPart) {
  constexpr std::size_t count = 10'001, parts = 7;
  const std::vector<Sums> sums = sums_of(count, parts);
  ASSERT_EQ(sums.size(), parts);
  std::vector<Sums> expected(parts);
  for (std::size_t v = 0; v < count; ++v) {
    Sums& part = expected[v * v % parts];
    const double value = std::sin(static_cast<double>(v));
    part.sum += value, part.largest = std::max(part.largest, value), ++part.count;
  }
  for (std::size_t p = 0; p < parts; ++p) {
    EXPECT_EQ(sums[p].count, expected[p].count) << p;
    EXPECT_EQ(sums[p].largest, expected[p].largest) << p;
    EXPECT_NEAR(sums[p].sum, expected[p].sum, 1e-11) << p;
  }
}

TEST(SumByPart, GivesTheSameBitsForAnyThreads) {
  set_thread_count(1);
  const std::vector<Sums> one = sums_of(10'001, 7);
  set_thread_count(4);
  const std::vector<Sums> four = sums_of(10'001, 7);
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(SumByPart, OfNothingIsZero) {
  EXPECT_EQ(sums_of(0, 3), std::vector<Sums>(3));
  EXPECT_EQ(sums_of(1, 1)[0].count, 1);
}

}  // namespace
}  // namespace muslin
