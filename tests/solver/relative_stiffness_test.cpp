// Stiffness against relative motion: products and diagonal blocks are those of the sum that the header
// states.
#include "muslin/solver/relative_stiffness.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

struct Terms {
  static constexpr int vertices = 40, first = 7;
  RelativeStiffness stiffness;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * vertices, 3 * vertices);

  explicit Terms(int count) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> any(-1, 1);
    stiffness.reset(first, vertices);
    const RelativeTerms terms =
        stiffness.resize(static_cast<std::size_t>(count), 4 * static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const Vec3 n = Vec3(any(random), any(random), any(random)).normalized();
      const double normal_stiffness = 5 + any(random), tangential = 1 + any(random);
      std::vector<RelativeTerms::Weight> weights;
      Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3, 3 * vertices);
      for (int k = 0; k < 4; ++k) {
        // Half of the vertices are part of no term.
        const int v = 2 * ((3 * i + k) % (vertices / 2));
        const double w = any(random);
        weights.push_back({v, static_cast<float>(w)});
        a.block<3, 3>(0, 3 * v) = static_cast<double>(static_cast<float>(w)) * Mat3::Identity();
      }
      terms.set(static_cast<std::size_t>(i), 4 * static_cast<std::size_t>(i), n, normal_stiffness, tangential,
                weights);
      const Mat3 block = tangential * Mat3::Identity() + (normal_stiffness - tangential) * n * n.transpose();
      dense += a.transpose() * block * a;
    }
    stiffness.finish();
  }
};

TEST(RelativeStiffness, MultipliesAsTheSumOfItsTerms) {
  Terms terms(60);
  std::mt19937_64 random(9);
  std::uniform_real_distribution<float> any(-1, 1);
  std::vector<Float4> p(Terms::first + Terms::vertices), y(p.size(), Float4{1, 2, 3, 0});
  Eigen::VectorXd q(3 * Terms::vertices);
  for (Float4& v : p) v = Float4{any(random), any(random), any(random), 0};
  for (int v = 0; v < Terms::vertices; ++v)
    for (int k = 0; k < 3; ++k) q[3 * v + k] = p[static_cast<std::size_t>(Terms::first + v)][k];
  const Eigen::VectorXd expected = terms.dense * q;
  const double energy = terms.stiffness.add_product(p.data() + Terms::first, y.data() + Terms::first);
  EXPECT_NEAR(energy, q.dot(expected), 1e-5 * q.dot(expected));
  for (int v = 0; v < Terms::vertices; ++v)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(y[static_cast<std::size_t>(Terms::first + v)][k] - static_cast<float>(k + 1),
                  expected[3 * v + k], 1e-4);
  for (std::size_t v = 0; v < Terms::first; ++v) EXPECT_EQ(y[v][0], 1) << "beyond the body";
}

TEST(RelativeStiffness, DiagonalBlocksAreThoseOfTheSumUpToABound) {
  Terms terms(60);
  constexpr std::size_t count = Terms::vertices;
  std::vector<float> identity(count, 1.0F);
  for (std::size_t v = 0; v < count; v += 4) identity[v] = 0.1F;  // lighter: their blocks are too stiff
  constexpr float most = 20;
  FloatVectors upper, lower;
  upper.resize(count), lower.resize(count);
  const Floats u = upper.data(), l = lower.data();
  for (float* each : {u.x, u.y, u.z, l.x, l.y, l.z}) std::fill_n(each, count, 0.0F);
  std::vector<std::uint8_t> fixed(count, 0);
  const double stiffest = terms.stiffness.add_diagonal(identity.data(), fixed.data(), most, u, l);
  double largest = 0;
  bool scaled = false, whole = false;
  for (std::size_t v = 0; v < count; ++v) {
    const auto at = static_cast<Eigen::Index>(3 * v);
    Mat3 block = terms.dense.block<3, 3>(at, at);
    const double bound = static_cast<double>(most * identity[v]);
    largest = std::max(largest, block.trace() / static_cast<double>(identity[v]));
    if (block.trace() > 0) (block.trace() > bound ? scaled : whole) = true;
    if (block.trace() > bound) block *= bound / block.trace();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR((k == 0 ? u.x : k == 1 ? u.y : u.z)[v], block(0, k), 1e-4);
    EXPECT_NEAR(l.x[v], block(1, 1), 1e-4);
    EXPECT_NEAR(l.y[v], block(1, 2), 1e-4);
    EXPECT_NEAR(l.z[v], block(2, 2), 1e-4);
  }
  EXPECT_TRUE(scaled && whole);
  EXPECT_NEAR(stiffest / largest, 1, 1e-5);
  fixed.assign(count, 1);
  EXPECT_EQ(terms.stiffness.add_diagonal(identity.data(), fixed.data(), most, u, l), 0);
}

TEST(RelativeStiffness, IsEmptyAfterReset) {
  Terms terms(5);
  terms.stiffness.reset(0, 3);
  terms.stiffness.finish();
  std::vector<Float4> p(3, Float4{1, 1, 1, 0}), y(3, Float4{});
  EXPECT_EQ(terms.stiffness.add_product(p.data(), y.data()), 0);
  for (const Float4& v : y) EXPECT_EQ(v[0], 0);
}

TEST(RelativeStiffness, GivesTheSameBitsForAnyThreads) {
  Terms terms(2000);
  std::vector<Float4> p(Terms::vertices, Float4{0.3F, -0.7F, 0.1F, 0}), one(p.size(), Float4{}), two = one;
  set_thread_count(1);
  const double a = terms.stiffness.add_product(p.data(), one.data());
  set_thread_count(2);
  const double b = terms.stiffness.add_product(p.data(), two.data());
  set_thread_count(0);
  EXPECT_EQ(a, b);
  for (std::size_t v = 0; v < one.size(); ++v)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(one[v][k], two[v][k]);
}

}  // namespace
}  // namespace muslin
