// The container of a checkpoint: what goes in comes out, and damage of any byte is noticed.
#include "muslin/simulation/checkpoint.hpp"

#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {
namespace {

std::vector<std::uint8_t> example() {
  ByteWriter out({42, 7, 3, 10});
  out.value(0.1);
  out.values(std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}});
  out.values(std::vector<std::uint8_t>{1, 0, 1});
  out.text("flag");
  return std::move(out).finish();
}

TEST(Checkpoint, GivesBackWhatWasWritten) {
  const auto bytes = example();
  const CheckpointHeader header = read_checkpoint_header(bytes);
  EXPECT_EQ(header.fingerprint, 42u);
  EXPECT_EQ(header.frame, 7);
  EXPECT_EQ(header.steps, 3);
  EXPECT_EQ(header.steps_per_frame, 10);
  ByteReader in(bytes);
  EXPECT_EQ(in.value<double>(), 0.1);
  EXPECT_EQ(in.values<Vec3>(), (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(in.values<std::uint8_t>(), (std::vector<std::uint8_t>{1, 0, 1}));
  EXPECT_EQ(in.text(), "flag");
  EXPECT_THROW(in.value<double>(), Error);
}

TEST(Checkpoint, NoticesEveryDamagedByteAndEveryCut) {
  const auto good = example();
  for (std::size_t i = 0; i < good.size(); ++i) {
    auto bad = good;
    bad[i] ^= 0x10;
    EXPECT_THROW(read_checkpoint_header(bad), Error) << "byte " << i;
    EXPECT_THROW(read_checkpoint_header(std::span(good).first(i)), Error) << "cut at " << i;
  }
}

TEST(Checkpoint, FingerprintIsThatOfTheBodies) {
  Model model;
  model.rest_positions = {{0, 0, 0}, {1, 0, 0}};
  model.masses = {1, 2};
  const auto fingerprint = model_fingerprint(model);
  Model other = model;
  other.scene.time.duration = 99;
  other.pins.push_back({});
  EXPECT_EQ(model_fingerprint(other), fingerprint);
  other = model;
  other.masses[1] = 2.5;
  EXPECT_NE(model_fingerprint(other), fingerprint);
  other = model;
  other.rest_positions[0].y() = 1e-12;
  EXPECT_NE(model_fingerprint(other), fingerprint);
  other = model;
  other.scene.bodies.push_back({});
  EXPECT_NE(model_fingerprint(other), fingerprint);
}

}  // namespace
}  // namespace muslin
