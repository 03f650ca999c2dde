// Distances of features: against brute force, by their gradients, for every degenerate shape.
#include "muslin/contact/distance.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace muslin {
namespace {

using Four = std::array<Vec3, 4>;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low = -1, double high = 1) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vec3 vector(double size = 1) { return size * Vec3((*this)(), (*this)(), (*this)()); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }

 private:
  std::mt19937_64 engine_;
};

/// The first kind's distance by minimising over barycentric coordinates with projected gradient steps: slow,
/// simple, and of other formulas.
double reference_distance(PairKind kind, const Four& x) {
  const auto distance = [&](double s, double t) {
    return kind == PairKind::vertex_triangle ? (x[0] - x[1] - s * (x[2] - x[1]) - t * (x[3] - x[1])).norm()
                                             : (x[0] + s * (x[1] - x[0]) - x[2] - t * (x[3] - x[2])).norm();
  };
  // The distance is convex in (s, t): nested ternary search.
  const auto search = [](const auto& f, double low, double high) {
    for (int i = 0; i < 90; ++i) {
      const double p = low + (high - low) / 3, q = high - (high - low) / 3;
      (f(p) <= f(q) ? high : low) = f(p) <= f(q) ? q : p;
    }
    return f((low + high) / 2);
  };
  return search(
      [&](double s) {
        return search([&](double t) { return distance(s, t); }, 0,
                      kind == PairKind::vertex_triangle ? 1 - s : 1);
      },
      0, 1);
}

/// Weights describe points of the features, and those are as far apart as is said.
void expect_consistent(PairKind kind, const Four& x, const ClosestPoints& c) {
  const auto first = static_cast<std::size_t>(first_feature_size(kind));
  double sum_a = 0, sum_b = 0;
  Vec3 difference = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    (i < first ? sum_a : sum_b) += c.weights[i];
    EXPECT_GE(i < first ? c.weights[i] : -c.weights[i], -1e-15);
    difference += c.weights[i] * x[i];
  }
  EXPECT_NEAR(sum_a, 1, 1e-14);
  EXPECT_NEAR(sum_b, -1, 1e-14);
  EXPECT_LT((difference - c.difference).norm(), 1e-14);
  EXPECT_NEAR(c.squared_distance, c.difference.squaredNorm(), 1e-14);
}

class Distance : public ::testing::TestWithParam<PairKind> {};

TEST_P(Distance, IsTheSmallestDistanceForAnyShape) {
  Random random(3);
  std::array<int, 16> features{};
  for (int trial = 0; trial < 300; ++trial) {
    Four x;
    for (Vec3& p : x) p = random.vector();
    switch (trial % 6) {
      case 1:  // needles and nearly parallel edges
        x[3] = x[2] + random.vector(1e-7);
        break;
      case 2:  // edges nearly parallel
        x[1] = x[0] + random() * (x[3] - x[2]) + random.vector(1e-6);
        break;
      case 3:  // exactly parallel
        x[1] = x[0] + (x[3] - x[2]);
        break;
      case 4:  // in one plane
        for (Vec3& p : x) p.y() = 0;
        break;
      case 5:  // segments and points
        x[static_cast<std::size_t>(random.below(4))] = x[static_cast<std::size_t>(random.below(4))];
        x[static_cast<std::size_t>(random.below(4))] = x[static_cast<std::size_t>(random.below(4))];
        break;
      default:
        break;
    }
    const ClosestPoints c = closest_points(GetParam(), x);
    expect_consistent(GetParam(), x, c);
    EXPECT_NEAR(c.distance(), reference_distance(GetParam(), x), 2e-8) << "trial " << trial;
    ++features[c.feature()];
  }
  // Interior, edges and corners have all been seen.
  EXPECT_GT(features[15], 0);
  EXPECT_GT(std::count_if(features.begin(), features.end(), [](int n) { return n > 0; }), 6);
}

TEST_P(Distance, GradientIsWeightsTimesNormal) {
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    Four x;
    for (Vec3& p : x) p = random.vector();
    const ClosestPoints c = closest_points(GetParam(), x);
    for (std::size_t i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) {
        const double h = 1e-6;
        Four plus = x, minus = x;
        plus[i][k] += h;
        minus[i][k] -= h;
        const double slope =
            (closest_points(GetParam(), plus).distance() - closest_points(GetParam(), minus).distance()) /
            (2 * h);
        EXPECT_NEAR(slope, c.weights[i] * c.difference[k] / c.distance(), 2e-5) << "trial " << trial;
      }
    }
  }
}

TEST_P(Distance, IsRigidMotionInvariant) {
  Random random(5);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()));
  for (int trial = 0; trial < 100; ++trial) {
    Four x, y;
    for (Vec3& p : x) p = random.vector();
    for (std::size_t i = 0; i < 4; ++i) y[i] = turn * x[i] + Vec3(1, 2, 3);
    EXPECT_NEAR(closest_points(GetParam(), x).distance(), closest_points(GetParam(), y).distance(), 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(Pairs, Distance, ::testing::Values(PairKind::vertex_triangle, PairKind::edge_edge),
                         [](const auto& kind) {
                           return kind.param == PairKind::vertex_triangle ? "VertexTriangle" : "EdgeEdge";
                         });

TEST(EdgeEdge, HandlesCrossingParallelAndCollinearEdges) {
  const ClosestPoints crossing = closest_edge_edge({-1, 0, 0}, {1, 0, 0}, {0, 0.5, -1}, {0, 0.5, 3});
  EXPECT_DOUBLE_EQ(crossing.distance(), 0.5);
  EXPECT_DOUBLE_EQ(crossing.weights[1], 0.5);
  EXPECT_DOUBLE_EQ(crossing.weights[3], -0.25);
  EXPECT_EQ(crossing.feature(), 15U);
  const ClosestPoints parallel = closest_edge_edge({0, 0, 0}, {1, 0, 0}, {0.5, 2, 0}, {4, 2, 0});
  EXPECT_DOUBLE_EQ(parallel.distance(), 2);
  EXPECT_NE(parallel.feature(), 15U);
  const ClosestPoints collinear = closest_edge_edge({0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {4, 0, 0});
  EXPECT_DOUBLE_EQ(collinear.distance(), 2);
  EXPECT_EQ(collinear.feature(), 0b0110U);
}

}  // namespace
}  // namespace muslin
