// Moving points out of PC2, MDD and numbered OBJ files; damaged ones are refused with the place.
#include "muslin/io/point_sequence_file.hpp"

#include <cstring>
#include <limits>

#include "cache/scratch.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "muslin/cache/point_cache.hpp"
#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using test::bytes_of;
using test::Scratch;
using test::write_bytes;

std::vector<Vec3f> frame_points(int frame) {
  const auto f = static_cast<float>(frame);
  return {Vec3f(0, f, 0), Vec3f(1, 2 * f, -f)};
}

void expect_moves(const PointSequence& sequence, double frame_rate) {
  ASSERT_EQ(sequence.points, 2u);
  ASSERT_EQ(sequence.times.size(), 4u);
  EXPECT_EQ(sequence.at(0, 1), Vec3(1, 0, 0));
  EXPECT_LT((sequence.at(2 / frame_rate, 1) - Vec3(1, 4, -2)).norm(), 1e-6);
  EXPECT_LT((sequence.at(2.25 / frame_rate, 1) - Vec3(1, 4.5, -2.25)).norm(), 1e-6);
  EXPECT_EQ(sequence.at(-1, 0), Vec3(0, 0, 0));
  EXPECT_EQ(sequence.at(99, 0), Vec3(0, 3, 0));
}

std::string refusal(const std::string& bytes, const std::string& suffix) {
  try {
    read_point_sequence_from(bytes, suffix, "points" + suffix, 24);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "";
}

TEST(PointSequence, ReadsPointCaches) {
  Scratch scratch;
  write_pc2(scratch / "a.pc2", 4, 2, frame_points);
  expect_moves(read_point_sequence(scratch / "a.pc2", 24), 24);
  write_mdd(scratch / "a.mdd", 4, 2, 30, frame_points);
  expect_moves(read_point_sequence(scratch / "a.mdd", 24), 30);  // its times are its own
}

TEST(PointSequence, CountsFramesAsThePc2HeaderSays) {
  Scratch scratch;
  write_pc2(scratch / "a.pc2", 4, 2, frame_points);
  std::string bytes = bytes_of(scratch / "a.pc2");
  const float start = 10, rate = 2;
  std::memcpy(bytes.data() + 20, &start, 4);
  std::memcpy(bytes.data() + 24, &rate, 4);
  const PointSequence sequence = read_point_sequence_from(bytes, ".pc2", "a.pc2", 10);
  EXPECT_THAT(sequence.times, testing::ElementsAre(1.0, 1.2, 1.4, 1.6));
}

TEST(PointSequence, NumberedFilesBeginAtTheSmallest) {
  Scratch scratch;
  for (int frame = 0; frame < 4; ++frame) {
    const auto p = frame_points(frame);
    std::string obj;
    for (const Vec3f& x : p)
      obj += "v " + std::to_string(x.x()) + " " + std::to_string(x.y()) + " " + std::to_string(x.z()) + "\n";
    write_bytes(scratch / ("walk." + std::to_string(98 + frame) + ".obj"), obj + "v 0 0 1\nf 1 2 3\n");
  }
  write_bytes(scratch / "walk.x.obj", "no mesh");
  const PointSequence sequence = read_point_sequence(scratch / "walk.###.obj", 24);
  ASSERT_EQ(sequence.times.size(), 4u);
  EXPECT_EQ(sequence.points, 3u);
  EXPECT_LT((sequence.at(2.0 / 24, 1) - Vec3(1, 4, -2)).norm(), 1e-6);
  write_bytes(scratch / "walk.102.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
  EXPECT_THROW(read_point_sequence(scratch / "walk.###.obj", 24), Error);
  EXPECT_THROW(read_point_sequence(scratch / "run.###.obj", 24), Error);
  EXPECT_THROW(read_point_sequence(scratch / "walk.98.obj", 24), Error);
}

TEST(PointSequence, NamesAMissingFrame) {
  Scratch scratch;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const int frame : {2, 4, 8, 10}) write_bytes(scratch / fmt::format("walk.{:04}.obj", frame), obj);
  try {
    read_point_sequence(scratch / "walk.####.obj", 24);
    FAIL() << "read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("frame 6 of the sequence is missing: walk.0004.obj is followed "
                                   "by walk.0008.obj"));
  }
  write_bytes(scratch / "walk.0006.obj", obj);
  EXPECT_EQ(read_point_sequence(scratch / "walk.####.obj", 24).times.size(), 5U);
}

TEST(PointSequence, RefusesDamagedCaches) {
  Scratch scratch;
  write_pc2(scratch / "a.pc2", 4, 2, frame_points);
  write_mdd(scratch / "a.mdd", 4, 2, 24, frame_points);
  const std::string pc2 = bytes_of(scratch / "a.pc2"), mdd = bytes_of(scratch / "a.mdd");
  EXPECT_THAT(refusal(pc2.substr(0, pc2.size() - 1), ".pc2"),
              testing::HasSubstr("promises 4 samples of 2 points"));
  EXPECT_THAT(refusal(mdd.substr(0, mdd.size() - 1), ".mdd"), testing::HasSubstr("cut off"));
  EXPECT_THAT(refusal(mdd, ".pc2"), testing::HasSubstr("this is not a PC2 point cache"));
  for (std::size_t length : {0u, 7u, 8u, 31u, 32u, 40u}) {
    EXPECT_NE(refusal(pc2.substr(0, length), ".pc2"), "") << length;
    EXPECT_NE(refusal(mdd.substr(0, length), ".mdd"), "") << length;
  }
  std::string bad = pc2;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bad.data() + 32 + 12 * 3 + 4, &nan, 4);
  EXPECT_THAT(refusal(bad, ".pc2"), testing::HasSubstr("point 1 of sample 1"));
  bad = pc2;
  const float rate = 0;
  std::memcpy(bad.data() + 24, &rate, 4);
  EXPECT_THAT(refusal(bad, ".pc2"), testing::HasSubstr("the time of sample 1 is not after the previous one"));
}

}  // namespace
}  // namespace muslin
