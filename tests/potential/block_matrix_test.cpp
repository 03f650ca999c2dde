// Block matrices: patterns, products against dense ones, same bits for any thread count.
#include "muslin/potential/block_matrix.hpp"

#include <cstring>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

TEST(BlockPattern, HasTheDiagonalAndBothSidesOfEveryPair) {
  const BlockPattern pattern({{0, 2}, {2, 0}, {3, 2}}, 4);
  EXPECT_THAT(pattern.first(), testing::ElementsAre(0, 2, 3, 6, 8));
  EXPECT_THAT(pattern.columns(), testing::ElementsAre(0, 2, 1, 0, 2, 3, 2, 3));
  EXPECT_EQ(pattern.find(2, 3), 5);
}

TEST(BlockMatrix, MultipliesAsADenseOneAndTheSameOnAnyNumberOfThreads) {
  const int count = 3000;
  std::mt19937 engine(3);
  std::vector<std::pair<int, int>> pairs;
  for (int v = 0; v < count; ++v) pairs.emplace_back(v, static_cast<int>(engine() % count));
  const auto pattern = std::make_shared<BlockPattern>(pairs, count);
  BlockMatrix matrix;
  matrix.reset(pattern, 0);
  const auto random = [&] { return static_cast<float>(engine() % 2001) / 1000 - 1; };
  for (std::size_t b = 0; b < pattern->block_count(); ++b) {
    for (int k = 0; k < 3; ++k)
      matrix.block(static_cast<int>(b))[k] = Float4{random(), random(), random(), 0};
  }
  FloatVectors p, y[2], upper, lower;
  for (FloatVectors* vectors : {&p, &y[0], &y[1], &upper, &lower}) vectors->resize(count);
  for (int v = 0; v < count; ++v)
    p.data().x[v] = random(), p.data().y[v] = random(), p.data().z[v] = random();
  double curvature[2];
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const Floats to = y[threads - 1].data();
    for (int v = 0; v < count; ++v) to.x[v] = to.y[v] = to.z[v] = 1;
    curvature[threads - 1] = matrix.add_product(p.data(), to);
  }
  set_thread_count(0);
  EXPECT_EQ(curvature[0], curvature[1]);
  double sum = 0;
  for (int v = 0; v < count; ++v) {
    double row[3] = {0, 0, 0};
    for (int b = pattern->first()[static_cast<std::size_t>(v)];
         b < pattern->first()[static_cast<std::size_t>(v) + 1]; ++b) {
      const int j = pattern->columns()[static_cast<std::size_t>(b)];
      const float from[3] = {p.data().x[j], p.data().y[j], p.data().z[j]};
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) row[i] += static_cast<double>(matrix.block(b)[k][i]) * from[k];
    }
    EXPECT_NEAR(y[0].data().x[v] - 1, row[0], 1e-5);
    EXPECT_NEAR(y[0].data().y[v] - 1, row[1], 1e-5);
    EXPECT_NEAR(y[0].data().z[v] - 1, row[2], 1e-5);
    EXPECT_EQ(y[0].data().x[v], y[1].data().x[v]);
    sum += row[0] * p.data().x[v] + row[1] * p.data().y[v] + row[2] * p.data().z[v];
  }
  EXPECT_NEAR(curvature[0], sum, 1e-3);
}

}  // namespace
}  // namespace muslin
