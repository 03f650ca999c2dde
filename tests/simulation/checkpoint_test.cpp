// The container of a checkpoint: what goes in comes out, and damage of any byte is noticed.
#include "muslin/simulation/checkpoint.hpp"

#include <gtest/gtest.h>

#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/simulation/fingerprint.hpp"

namespace muslin {
namespace {

std::vector<std::uint8_t> example() {
  CheckpointWriter out({42, 7, 3, 10});
  out("length", 0.1);
  out("positions", std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}});
  out("held", std::vector<std::uint8_t>{1, 0, 1});
  out("none", std::vector<double>());
  return std::move(out).finish();
}

TEST(Checkpoint, ReadsArraysInAnyOrder) {
  const auto bytes = example();
  const CheckpointHeader header = read_checkpoint_header(bytes);
  EXPECT_EQ(header.fingerprint, 42u);
  EXPECT_EQ(header.frame, 7);
  EXPECT_EQ(header.steps, 3);
  EXPECT_EQ(header.steps_per_frame, 10);
  CheckpointReader in(bytes);
  std::vector<std::uint8_t> held;
  std::vector<Vec3> positions;
  std::vector<double> none = {1, 2};
  double length = 0;
  in("held", held);
  in("positions", positions);
  in("none", none);
  EXPECT_THROW(in.finish(), Error) << "nobody has asked for the length";
  in("length", length);
  EXPECT_NO_THROW(in.finish());
  EXPECT_EQ(length, 0.1);
  EXPECT_EQ(positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(held, (std::vector<std::uint8_t>{1, 0, 1}));
  EXPECT_TRUE(none.empty());
}

TEST(Checkpoint, DoesNotChangeArraysThatWereNotWritten) {
  const auto bytes = example();
  CheckpointReader in(bytes);
  double width = 3;
  std::vector<Vec3> anchors = {{1, 2, 3}};
  in("width", width);
  in("anchors", anchors);
  EXPECT_EQ(width, 3);
  EXPECT_EQ(anchors.size(), 1U);
}

TEST(Checkpoint, RefusesOtherTypesAndCounts) {
  const auto bytes = example();
  CheckpointReader in(bytes);
  std::int64_t whole = 0;
  std::vector<double> numbers;
  Vec3 one;
  EXPECT_THROW(in("length", whole), Error);
  EXPECT_THROW(in("positions", numbers), Error);
  EXPECT_THROW(in("positions", one), Error);
}

TEST(Checkpoint, RefusesADuplicateName) {
  CheckpointWriter out({});
  out("length", 0.1);
  out("length", 0.2);
  const auto bytes = std::move(out).finish();
  EXPECT_THROW(CheckpointReader{bytes}, Error);
}

TEST(Checkpoint, RefusesAnOlderFormatByItsNumber) {
  auto bytes = example();
  bytes[8] = 3;
  try {
    read_checkpoint_header(bytes);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem(), "the checkpoint has format 3, this muslin reads 4");
  }
}

TEST(Checkpoint, DetectsEveryDamagedByteAndEveryTruncation) {
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
  other.bodies.push_back(std::make_shared<LatticeBody>());
  EXPECT_NE(model_fingerprint(other), fingerprint);
}

}  // namespace
}  // namespace muslin
