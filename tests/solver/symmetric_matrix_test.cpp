// Symmetric matrices of blocks: patterns, products against dense ones, same bits for any thread count.
#include "muslin/solver/symmetric_matrix.hpp"

#include <array>
#include <cstring>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

TEST(SymmetricPattern, HasTheDiagonalAndOneSideOfEveryPair) {
  const SymmetricPattern pattern({{0, 2}, {2, 0}, {3, 2}}, 4);
  EXPECT_THAT(pattern.first(), testing::ElementsAre(0, 2, 3, 5, 6));
  EXPECT_THAT(pattern.columns(), testing::ElementsAre(0, 2, 1, 2, 3, 3));
  EXPECT_EQ(pattern.find(2, 3), 4);
  EXPECT_THAT(pattern.first_mirrored(), testing::ElementsAre(0, 0, 0, 1, 2));
  ASSERT_EQ(pattern.mirrored().size(), 2U);
  EXPECT_EQ(pattern.mirrored()[0].block, 1);
  EXPECT_EQ(pattern.mirrored()[0].row, 0);
  EXPECT_EQ(pattern.mirrored()[1].block, 4);
  EXPECT_EQ(pattern.mirrored()[1].row, 2);
}

TEST(SymmetricMatrix, MultipliesAsADenseOneAndTheSameOnAnyNumberOfThreads) {
  const int count = 3000;
  std::mt19937 engine(3);
  std::vector<std::pair<int, int>> pairs;
  for (int v = 0; v < count; ++v) pairs.emplace_back(v, static_cast<int>(engine() % count));
  const auto pattern = std::make_shared<SymmetricPattern>(pairs, count);
  SymmetricMatrix matrix;
  matrix.reset(pattern, 0);
  const auto random = [&] { return static_cast<float>(engine() % 2001) / 1000 - 1; };
  for (int b = 0; b < static_cast<int>(pattern->block_count()); ++b)
    for (int k = 0; k < 3; ++k) matrix.block(b)[k] = Float4{random(), random(), random(), 0};
  // Diagonal blocks are symmetric themselves.
  for (std::size_t v = 0; v < count; ++v) {
    Float4* const c = matrix.block(pattern->first()[v]);
    c[0][1] = c[1][0], c[0][2] = c[2][0], c[1][2] = c[2][1];
  }
  std::vector<Float4> p(count);
  for (Float4& each : p) each = Float4{random(), random(), random(), 0};
  std::vector<Float4> y[2];
  double curvature[2];
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    std::vector<Float4>& to = y[threads - 1];
    to.assign(count, Float4{1, 1, 1, 0});
    curvature[threads - 1] = matrix.add_product(p.data(), to.data());
  }
  set_thread_count(0);
  EXPECT_EQ(curvature[0], curvature[1]);
  EXPECT_EQ(0, std::memcmp(y[0].data(), y[1].data(), count * sizeof(Float4)));

  std::vector<std::array<double, 3>> dense(count, {0, 0, 0});
  for (int row = 0; row < count; ++row) {
    for (int b = pattern->first()[static_cast<std::size_t>(row)];
         b < pattern->first()[static_cast<std::size_t>(row) + 1]; ++b) {
      const int column = pattern->columns()[static_cast<std::size_t>(b)];
      for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 3; ++i) {
          const double a = static_cast<double>(matrix.block(b)[k][i]);
          dense[static_cast<std::size_t>(row)][static_cast<std::size_t>(i)] +=
              a * static_cast<double>(p[static_cast<std::size_t>(column)][k]);
          if (row != column)
            dense[static_cast<std::size_t>(column)][static_cast<std::size_t>(k)] +=
                a * static_cast<double>(p[static_cast<std::size_t>(row)][i]);
        }
      }
    }
  }
  double sum = 0;
  for (std::size_t v = 0; v < count; ++v) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(y[0][v][k] - 1, dense[v][static_cast<std::size_t>(k)], 1e-5);
      sum += dense[v][static_cast<std::size_t>(k)] * static_cast<double>(p[v][k]);
    }
  }
  EXPECT_NEAR(curvature[0], sum, 1e-3);
}

}  // namespace
}  // namespace muslin
