// Linearization as the sink of Hessians: rank-one terms and general potentials against dense matrices.
#include "muslin/solver/linearization.hpp"

#include "support/linearized_product.hpp"
#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

namespace muslin {
namespace {

constexpr std::size_t count = 40, first = 7;

struct System {
  std::vector<double> masses = std::vector<double>(count, 0.5);
  std::vector<std::uint8_t> fixed = std::vector<std::uint8_t>(count, 0);
  RankOneTerm term{3.0, {0, 4, 5, 20, 31}, test::random_vectors(5, 1, 2)};
  Linearization h;

  void add() {
    h.reset(masses, fixed, 1);
    h.add_rank_one(term, first);
    h.finish();
  }
  double along(ConstVectors p) const {
    double sum = 0;
    for (std::size_t i = 0; i < term.vertices.size(); ++i)
      sum += term.gradients[i].dot(p[first + static_cast<std::size_t>(term.vertices[i])]);
    return sum;
  }
};

TEST(Linearization, RankOneTermMultipliesAsItsDyad) {
  System system;
  system.add();
  ASSERT_TRUE(system.h.has_remainder());
  const std::vector<Vec3> p = test::random_vectors(count, 1, 3);
  std::vector<Vec3> expected = p;
  for (Vec3& v : expected) v *= 0.5;
  for (std::size_t i = 0; i < system.term.vertices.size(); ++i)
    expected[first + static_cast<std::size_t>(system.term.vertices[i])] +=
        3 * system.along(p) * system.term.gradients[i];
  const std::vector<Vec3> product = test::product(system.h, p);
  for (std::size_t v = 0; v < count; ++v) EXPECT_LE((product[v] - expected[v]).norm(), 1e-5) << v;
}

TEST(Linearization, RankOneTermHasTheDiagonalBlocksOfItsDyad) {
  System system;
  system.add();
  const Floats u = system.h.remainder_upper().data(), l = system.h.remainder_lower().data();
  for (std::size_t i = 0; i < system.term.vertices.size(); ++i) {
    const std::size_t v = first + static_cast<std::size_t>(system.term.vertices[i]);
    const Mat3 block = 3 * system.term.gradients[i] * system.term.gradients[i].transpose();
    EXPECT_NEAR(u.x[v], block(0, 0), 1e-5);
    EXPECT_NEAR(u.y[v], block(0, 1), 1e-5);
    EXPECT_NEAR(u.z[v], block(0, 2), 1e-5);
    EXPECT_NEAR(l.x[v], block(1, 1), 1e-5);
    EXPECT_NEAR(l.y[v], block(1, 2), 1e-5);
    EXPECT_NEAR(l.z[v], block(2, 2), 1e-5);
  }
  EXPECT_EQ(u.x[0], 0);
}

TEST(Linearization, RankOneTermOfNegativeFactorIsLeftOut) {
  System system;
  system.term.factor = -1;
  system.add();
  EXPECT_FALSE(system.h.has_remainder());
}

/// A chain whose blocks are not those of springs, with rows that sum to zero.
TEST(Linearization, StandInLeavesTheSystemAsItIsAndMakesItsBlocksCouplings) {
  constexpr int chain = 50;
  std::vector<std::pair<int, int>> pairs;
  for (int v = 0; v + 1 < chain; ++v) pairs.emplace_back(v, v + 1);
  for (int v = 0; v + 2 < chain; ++v) pairs.emplace_back(v, v + 2);
  const auto pattern = std::make_shared<const SymmetricPattern>(pairs, chain);
  SpringNetwork springs;
  springs.vertex_count = chain;
  springs.runs = {{0, 0, 1, chain - 1}, {1, 0, 2, chain - 2}};
  const auto network = std::make_shared<const SpringNetwork>(springs);
  const std::vector<Vec3> x = test::random_vectors(chain, 1, 8), p = test::random_vectors(chain, 1, 9);
  const std::vector<double> masses(chain, 0.1);
  const std::vector<std::uint8_t> fixed(chain, 0);
  std::vector<Vec3> products[2];
  Linearization h;
  for (const bool with : {false, true}) {
    h.reset(masses, fixed, 1);
    const PairBlocks blocks = h.pair_blocks(pattern, 0);
    for (const auto& [a, b] : pairs) {
      // Antisymmetric parts cancel in the diagonal blocks along the chain.
      const double turn = b == a + 1 ? 0.7 : -0.35;
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          const Vec3& at = x[static_cast<std::size_t>(a)];
          const auto value = static_cast<float>(at[c] * at[r] + (c == r ? 2 : 0));
          blocks.block(pattern->find(a, b))[c][r] -=
              value + static_cast<float>(c == r ? 0 : turn * (c > r ? 1 : -1));
          if (with) continue;
          blocks.block(pattern->find(a, a))[c][r] += value;
          blocks.block(pattern->find(b, b))[c][r] += value;
        }
      }
    }
    const CentralSpring kinds[] = {{1.5F, 0}, {0.5F, 0}};
    if (with) h.stand_in(pattern, network, kinds, x, 0);
    h.finish();
    EXPECT_EQ(h.has_springs(), with);
    EXPECT_EQ(h.matrices().empty(), with);
    products[with ? 1 : 0] = test::product(h, p);
  }
  for (std::size_t v = 0; v < chain; ++v) EXPECT_LE((products[0][v] - products[1][v]).norm(), 3e-5) << v;
  h.project();
  EXPECT_EQ(h.full(*h.sets()[0]), nullptr);
  for (std::uint32_t seed = 1; seed < 5; ++seed) {
    const std::vector<Vec3> q = test::random_vectors(chain, 1, seed);
    EXPECT_GT(test::inner(q, test::product(h, q)), 0);
  }
}

}  // namespace
}  // namespace muslin
