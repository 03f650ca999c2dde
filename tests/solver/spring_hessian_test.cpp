// Precision of couplings of 8 bytes, and their projection.
#include "muslin/solver/spring_hessian.hpp"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "muslin/core/vectors.hpp"

namespace muslin {
namespace {

constexpr int lanes = SpringHessian::lanes;

struct Numbers {
  float sx[lanes], sy[lanes], sz[lanes], t[lanes];
  Mat3 block(int l) const {
    const Vec3 s(sx[l], sy[l], sz[l]);
    return s * s.transpose() + static_cast<double>(t[l]) * Mat3::Identity();
  }
};

class SpringHessianTest : public testing::Test {
 protected:
  SpringHessianTest() {
    std::mt19937 random(1);
    const auto uniform = [&] { return static_cast<float>(random()) / 2147483648.0F - 1; };
    for (std::size_t b = 0; b < pattern_->block_count(); ++b) {
      Numbers& n = numbers_.emplace_back();
      for (int l = 0; l < lanes; ++l) {
        n.sx[l] = 30 * uniform(), n.sy[l] = 30 * uniform(), n.sz[l] = 30 * uniform();
        n.t[l] = 400 * uniform();  // |s|² + t of either sign
      }
      couplings_.store(b, 1, n.sx, n.sy, n.sz, n.t);
    }
  }
  Numbers stored(std::size_t block) const {
    Numbers n;
    couplings_.load(block, 1, n.sx, n.sy, n.sz, n.t);
    return n;
  }

  std::shared_ptr<const EliminationOrder> pattern_ =
      std::make_shared<const EliminationOrder>(std::vector<CouplingRun>{{0, 0, 1, 99}}, 100);
  SpringHessian couplings_{pattern_, 0};
  std::vector<Numbers> numbers_;
};

TEST_F(SpringHessianTest, KeepSTo3e5OfTheLargestAndTTo4e3) {
  for (std::size_t b = 0; b < numbers_.size(); ++b) {
    const Numbers kept = stored(b);
    for (int l = 0; l < lanes; ++l) {
      EXPECT_NEAR(kept.sx[l], numbers_[b].sx[l], 2e-5 * 30);
      EXPECT_NEAR(kept.sy[l], numbers_[b].sy[l], 2e-5 * 30);
      EXPECT_NEAR(kept.sz[l], numbers_[b].sz[l], 2e-5 * 30);
      EXPECT_NEAR(kept.t[l], numbers_[b].t[l], 4e-3 * std::abs(numbers_[b].t[l]));
    }
  }
}

TEST_F(SpringHessianTest, ProjectedHaveTheirNonnegativeEigenvaluesOnly) {
  std::vector<Mat3> expected;
  for (std::size_t b = 0; b < numbers_.size(); ++b) {
    const Numbers kept = stored(b);
    for (int l = 0; l < lanes; ++l) {
      const Eigen::SelfAdjointEigenSolver<Mat3> eigen(kept.block(l));
      expected.emplace_back(eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
                            eigen.eigenvectors().transpose());
    }
  }
  couplings_.project();
  for (std::size_t b = 0; b < numbers_.size(); ++b) {
    const Numbers kept = stored(b);
    for (int l = 0; l < lanes; ++l)
      EXPECT_LE((kept.block(l) - expected[b * lanes + static_cast<std::size_t>(l)]).norm(), 1.0)
          << b << " " << l;
  }
}

TEST_F(SpringHessianTest, ClearedAreZero) {
  couplings_.clear();
  const Numbers kept = stored(0);
  for (int l = 0; l < lanes; ++l) EXPECT_EQ(kept.block(l), Mat3::Zero());
}

}  // namespace
}  // namespace muslin
