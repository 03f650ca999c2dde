#include "muslin/solver/multilevel.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr int side = 60;
constexpr std::size_t count = side * side;  // several chunks

/// A net of springs held at one edge, its nodes numbered row by row, or at random.
struct Net {
  std::vector<Vec3> points = std::vector<Vec3>(count);
  std::shared_ptr<const BlockPattern> pattern;
  std::unique_ptr<Multilevel> multilevel;
  std::vector<int> number = std::vector<int>(count);

  explicit Net(bool at_random) {
    std::iota(number.begin(), number.end(), 0);
    std::mt19937 random(5);
    if (at_random) std::shuffle(number.begin(), number.end(), random);
    std::vector<std::pair<int, int>> pairs;
    const auto node = [&](int i, int k) { return number[static_cast<std::size_t>(i + k * side)]; };
    for (int k = 0; k < side; ++k) {
      for (int i = 0; i < side; ++i) {
        points[static_cast<std::size_t>(node(i, k))] = Vec3(i, 0.2 * i * k / side, k);
        if (i + 1 < side) pairs.emplace_back(node(i, k), node(i + 1, k));
        if (k + 1 < side) pairs.emplace_back(node(i, k), node(i, k + 1));
      }
    }
    pattern = std::make_shared<const BlockPattern>(pairs, count);
    const std::vector<int> components(count, 0);
    multilevel = std::make_unique<Multilevel>(pattern, points, components, std::vector<double>{2.0});
    multilevel->matrix().reset(*pattern);
    for (const auto& [a, b] : pairs) {
      const Vec3 n = (points[at(a)] - points[at(b)]).normalized();
      const Mat3 block = 0.3 * Mat3::Identity() + n * n.transpose();
      add(a, a, block), add(b, b, block), add(a, b, -block), add(b, a, -block);
    }
    for (int i = 0; i < side; ++i) add(node(i, 0), node(i, 0), Mat3::Identity());
    multilevel->prepare();
  }

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  void add(int row, int column, const Mat3& block) {
    Float4* const to = multilevel->matrix().block(pattern->find(row, column));
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) to[c][r] += static_cast<float>(block(r, c));
  }

  std::vector<Vec3> times(const std::vector<Vec3>& x) const {
    std::vector<Vec3> y(count, Vec3::Zero());
    for (std::size_t row = 0; row < count; ++row) {
      for (int k = pattern->first()[row]; k < pattern->first()[row + 1]; ++k) {
        const Float4* const a = multilevel->matrix().block(k);
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r)
            y[row][r] += static_cast<double>(a[c][r]) * x[at(pattern->columns()[at(k)])][c];
      }
    }
    return y;
  }
  std::vector<Vec3> solve(const std::vector<Vec3>& b) {
    for (std::size_t i = 0; i < count; ++i)
      for (int c = 0; c < 3; ++c) multilevel->right_side()[i][c] = static_cast<float>(b[i][c]);
    multilevel->solve();
    std::vector<Vec3> x(count);
    for (std::size_t i = 0; i < count; ++i)
      for (int c = 0; c < 3; ++c) x[i][c] = static_cast<double>(multilevel->solution()[i][c]);
    return x;
  }
};

std::vector<Vec3> any_vectors(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<Vec3> x(count);
  for (Vec3& v : x) v = Vec3(any(random), any(random), any(random));
  return x;
}

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += a[i].dot(b[i]);
  return sum;
}

class NumberedNet : public testing::TestWithParam<bool> {};

TEST_P(NumberedNet, InverseIsSymmetricAndPositive) {
  Net net(GetParam());
  const std::vector<Vec3> u = any_vectors(1), v = any_vectors(2);
  const std::vector<Vec3> bu = net.solve(u), bv = net.solve(v);
  EXPECT_GT(dot(u, bu), 0);
  EXPECT_NEAR(dot(u, bv), dot(v, bu), 1e-4 * dot(u, bu));
}

/// Also for the smoothest errors, and also if nearly all couplings are between chunks.
TEST_P(NumberedNet, EveryCycleReducesTheError) {
  Net net(GetParam());
  for (const bool smooth : {false, true}) {
    std::vector<Vec3> error = any_vectors(3);
    if (smooth)
      for (std::size_t i = 0; i < count; ++i) error[i] = Vec3(net.points[i].z(), 1, net.points[i].x()) / side;
    double energy = dot(error, net.times(error));
    const double first = energy;
    for (int cycle = 0; cycle < 6; ++cycle) {
      const std::vector<Vec3> correction = net.solve(net.times(error));
      for (std::size_t i = 0; i < count; ++i) error[i] -= correction[i];
      const double next = dot(error, net.times(error));
      EXPECT_LT(next, 0.9 * energy) << "cycle " << cycle;
      energy = next;
    }
    EXPECT_LT(energy, (GetParam() ? 0.1 : 0.01) * first);
  }
}

TEST_P(NumberedNet, GivesTheSameBitsForAnyThreads) {
  const std::vector<Vec3> b = any_vectors(4);
  set_thread_count(1);
  const std::vector<Vec3> one = Net(GetParam()).solve(b);
  set_thread_count(3);
  const std::vector<Vec3> three = Net(GetParam()).solve(b);
  set_thread_count(0);
  EXPECT_EQ(one, three);
}

INSTANTIATE_TEST_SUITE_P(Multilevel, NumberedNet, testing::Bool(),
                         [](const auto& info) { return info.param ? "AtRandom" : "RowByRow"; });

}  // namespace
}  // namespace muslin
