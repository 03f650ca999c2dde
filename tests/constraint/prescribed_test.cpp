// Vertices that move along keyframes.
#include "muslin/constraint/prescribed.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace muslin {
namespace {

TEST(Prescribed, IsStaticWithoutKeys) {
  Prescribed p;
  p.first = 1;
  p.start = {{1, 2, 3}};
  std::vector<std::uint8_t> fixed(3, 0);
  std::vector<Vec3> targets(3, Vec3::Zero());
  p.hold(7, fixed, targets);
  EXPECT_EQ(fixed, (std::vector<std::uint8_t>{0, 1, 0}));
  EXPECT_EQ(targets[1], Vec3(1, 2, 3));
  EXPECT_EQ(targets[2], Vec3::Zero());
}

TEST(Prescribed, MotionIsRelativeToTimeZero) {
  Prescribed p;
  p.motion.pivot = Vec3(1, 0, 0);
  p.motion.keys = {
      {0, Vec3(0, 5, 0), Eigen::Quaterniond::Identity()},
      {2, Vec3(0, 7, 0), Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()))}};
  p.start = {{2, 5, 0}};  // one beside the pivot, lifted by the first key already
  Vec3 x;
  p.positions(0, Vectors(&x, 1));
  EXPECT_LT((x - Vec3(2, 5, 0)).norm(), 1e-14);
  p.positions(2, Vectors(&x, 1));
  EXPECT_LT((x - Vec3(1, 8, 0)).norm(), 1e-14);
  p.positions(1, Vectors(&x, 1));
  EXPECT_LT((x - Vec3(1 + std::sqrt(0.5), 6 + std::sqrt(0.5), 0)).norm(), 1e-14);
  p.positions(9, Vectors(&x, 1));
  EXPECT_LT((x - Vec3(1, 8, 0)).norm(), 1e-14);
}

}  // namespace
}  // namespace muslin
