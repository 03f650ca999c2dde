// Anderson's acceleration: exact for affine iterations once it looks back far enough, and far faster than the
// iteration it is given.
#include "muslin/solver/anderson.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

/// f(x) = D (b − x) entry by entry, so that x ← x + f(x) has the factors 1 − D: slow, and alternating.
struct Affine {
  std::vector<double> rates;

  void step(ConstVectors x, Vectors f) const {
    for (std::size_t v = 0; v < x.size(); ++v)
      for (int k = 0; k < 3; ++k)
        f[v][k] = rates[(3 * v + static_cast<std::size_t>(k)) % rates.size()] * (solution(v, k) - x[v][k]);
  }
  static double solution(std::size_t v, int k) { return std::sin(static_cast<double>(3 * v) + k); }
};

std::size_t iterations(const Affine& f, std::size_t depth, std::size_t most, std::vector<Vec3>& x) {
  std::vector<Vec3> step(x.size()), more(x.size());
  AndersonMixing mixing(depth);
  for (std::size_t i = 1; i <= most; ++i) {
    f.step(x, step);
    double largest = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
      x[v] += step[v];
      largest = std::max(largest, step[v].norm());
    }
    if (largest < 1e-10) return i;
    if (depth > 0 && mixing.mix(x, step, more))
      for (std::size_t v = 0; v < x.size(); ++v) x[v] += more[v];
  }
  return most;
}

TEST(AndersonMixing, SolvesAffineIterationsOfFewFactorsAtOnce) {
  const Affine f{{0.05, 1.97, 0.3}};
  std::vector<Vec3> plain(500, Vec3::Zero()), mixed = plain;
  EXPECT_GT(iterations(f, 0, 2000, plain), 400U);
  // Three factors: three differences, with the step before and one more to see it, and rounding.
  EXPECT_LE(iterations(f, 5, 2000, mixed), 7U);
  for (std::size_t v = 0; v < mixed.size(); ++v)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mixed[v][k], Affine::solution(v, k), 1e-8);
}

TEST(AndersonMixing, KnowsNothingAfterOneStepOrWhenCleared) {
  const std::vector<Vec3> there(4, Vec3(1, 2, 3)), step(4, Vec3(0.1, 0, 0));
  std::vector<Vec3> more(4);
  AndersonMixing mixing(3);
  EXPECT_FALSE(mixing.mix(there, step, more));
  EXPECT_TRUE(mixing.mix(there, step, more))
      << "the same again: nothing to mix, and nothing that is not finite";
  for (const Vec3& m : more) EXPECT_EQ(m, Vec3(0, 0, 0));
  mixing.clear();
  EXPECT_FALSE(mixing.mix(there, step, more));
}

TEST(AndersonMixing, GivesTheSameBitsForAnyThreads) {
  const Affine f{{0.02, 1.9, 0.7, 0.11, 1.3}};
  std::vector<Vec3> one(20000, Vec3::Zero()), two = one;
  set_thread_count(1);
  const std::size_t n = iterations(f, 4, 30, one);
  set_thread_count(2);
  EXPECT_EQ(iterations(f, 4, 30, two), n);
  set_thread_count(0);
  EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace muslin
