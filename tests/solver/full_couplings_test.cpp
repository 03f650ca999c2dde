// Full couplings as stored, against the blocks that they were made of.
#include "muslin/solver/full_couplings.hpp"

#include <cmath>
#include <vector>

#include "support/potential_battery.hpp"
#include <gtest/gtest.h>

namespace muslin {
namespace {

TEST(FullCouplings, KeepEntriesTo5e7OfTheLargestOfTheirBlock) {
  constexpr int lanes = FullCouplings::lanes;
  const auto pattern =
      std::make_shared<const SymmetricPattern>(std::vector<std::pair<int, int>>{{0, 1}, {1, 2}}, 3);
  SymmetricMatrix matrix;
  matrix.reset(pattern, 0);
  const std::vector<Vec3> random = test::random_vectors(6, 1e3, 1);
  for (int b = 0; b < 2; ++b)
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        matrix.block(pattern->find(b, b + 1))[c][r] =
            static_cast<float>(random[static_cast<std::size_t>(3 * b + c)][r] * (b == 0 ? 1 : 1e-3));
  // The first block as it is and transposed, also side by side, and the second in a block of its own.
  std::vector<int> slots(2 * lanes, FullCouplings::none);
  slots[2] = pattern->find(0, 1), slots[3] = slots[9] = ~pattern->find(0, 1),
  slots[lanes + 15] = pattern->find(1, 2);
  FullCouplings couplings;
  couplings.set(matrix, slots);
  for (std::size_t block = 0; block < 2; ++block) {
    float entries[9 * lanes];
    couplings.load(block, entries);
    const double largest = block == 0 ? 1e3 : 1;
    for (std::size_t l = 0; l < lanes; ++l) {
      const int slot = slots[block * lanes + l];
      for (std::size_t k = 0; k < 9; ++k) {
        float expected = 0;
        if (slot != FullCouplings::none) {
          const Float4* const columns = matrix.block(slot < 0 ? ~slot : slot);
          expected = slot < 0 ? -columns[k / 3][k % 3] : -columns[k % 3][k / 3];
        }
        EXPECT_NEAR(entries[k * lanes + l], expected, 5e-7 * largest) << block << " " << l << " " << k;
      }
    }
  }
}

TEST(FullCouplings, OfNothingAreZero) {
  const auto pattern = std::make_shared<const SymmetricPattern>(std::vector<std::pair<int, int>>{{0, 1}}, 2);
  SymmetricMatrix matrix;
  matrix.reset(pattern, 0);
  FullCouplings couplings;
  couplings.set(matrix, std::vector<int>(FullCouplings::lanes, pattern->find(0, 1)));
  float entries[9 * FullCouplings::lanes];
  couplings.load(0, entries);
  for (const float entry : entries) EXPECT_EQ(entry, 0);
}

}  // namespace
}  // namespace muslin
