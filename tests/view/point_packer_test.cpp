// Packing loses nothing but what 16 bits cannot hold.
#include "muslin/view/point_packer.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace muslin {
namespace {

/// Decodes as the page does, written from the format in the header.
std::vector<std::vector<Vec3>> unpack(const std::string& record, int frames, std::size_t points,
                                      const Vec3& low, const Vec3& size) {
  std::vector<std::vector<Vec3>> result;
  std::vector<std::array<std::vector<int>, 3>> words;
  std::size_t at = 0;
  for (int f = 0; f < frames; ++f) {
    words.emplace_back();
    result.emplace_back(points);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int way = record.at(at++);
      int beside = 0;
      for (std::size_t p = 0; p < points; ++p) {
        const auto low_byte = static_cast<unsigned char>(record.at(at + p));
        const auto high_byte = static_cast<unsigned char>(record.at(at + points + p));
        const int folded = low_byte + 256 * high_byte;
        int off = folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2;
        if (way & 2) off += beside;
        beside = off;
        const auto before = [&](int age) {
          return f < age ? 0 : words[static_cast<std::size_t>(f - age)][axis][p];
        };
        const int expected = way & 1 ? 2 * before(1) - before(2) : before(1);
        const int q = (expected + off) & 0xffff;
        words.back()[axis].push_back(q);
        const auto a = static_cast<Eigen::Index>(axis);
        result.back()[p][a] = low[a] + q * size[a] / 65535;
      }
      at += 2 * points;
    }
  }
  EXPECT_EQ(at, record.size());
  return result;
}

void expect_within_half_a_step(const std::vector<std::vector<Vec3f>>& frames) {
  Box box;
  for (const auto& frame : frames)
    for (const Vec3f& p : frame) box.extend(p.cast<double>());
  const Vec3 low = box.min(), size = box.sizes();
  PointPacker packer(low, size, frames[0].size());
  std::string record;
  for (const auto& frame : frames) packer.append(frame, record);
  const auto shown = unpack(record, static_cast<int>(frames.size()), frames[0].size(), low, size);
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t p = 0; p < frames[f].size(); ++p)
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        ASSERT_LE(std::abs(shown[f][p][axis] - static_cast<double>(frames[f][p][axis])),
                  size[axis] / 131070 * (1 + 1e-6))
            << "frame " << f << " point " << p;
}

TEST(PointPacker, KeepsWildMotionWithinHalfAStep) {
  // Leaps from end to end of the box: every difference wraps around.
  std::mt19937 random(3);
  std::uniform_real_distribution<float> anywhere(-7, 5);
  std::vector<std::vector<Vec3f>> frames(9, std::vector<Vec3f>(50));
  for (auto& frame : frames)
    for (Vec3f& p : frame) p = {anywhere(random), anywhere(random), anywhere(random)};
  expect_within_half_a_step(frames);
}

TEST(PointPacker, KeepsSmoothMotionWithinHalfAStep) {
  std::vector<std::vector<Vec3f>> frames;
  for (int f = 0; f < 30; ++f) {
    frames.emplace_back();
    for (int p = 0; p < 200; ++p) {
      const float s = 0.03f * static_cast<float>(p), t = 0.1f * static_cast<float>(f);
      frames.back().emplace_back(s, std::sin(2 * s + t), std::cos(s - t) - 1e3f);
    }
  }
  expect_within_half_a_step(frames);
}

TEST(PointPacker, KeepsFlatAndSinglePoints) {
  expect_within_half_a_step({{{1, 2, 3}, {4, 2, 6}}, {{1, 2, 5}, {4, 2, 6}}});
  expect_within_half_a_step({{{1, 2, 3}}});
}

TEST(PointPacker, PutsSmoothMotionIntoLowBytes) {
  // A sheet that falls: but for the first point, high bytes are zero, which is what deflate thrives on.
  const std::size_t points = 400;
  PointPacker packer(Vec3(0, -5, 0), Vec3(1, 5, 1), points);
  std::string last;
  for (int f = 0; f < 20; ++f) {
    std::vector<Vec3f> frame;
    for (std::size_t p = 0; p < points; ++p)
      frame.emplace_back(0.05f * static_cast<float>(p % 20),
                         -0.5f * 9.81f * std::pow(static_cast<float>(f) / 24, 2.f),
                         0.05f * static_cast<float>(p / 20));
    last.clear();
    packer.append(frame, last);
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t p = 1; p < points; ++p) ASSERT_EQ(last[axis * (1 + 2 * points) + 1 + points + p], 0);
}

}  // namespace
}  // namespace muslin
