// A stretch limit over time: it grows at once, shrinks at once as far as no energy changes, and from there
// by all of the length in a second.
#include "muslin/energy/keyed_stretch_limit.hpp"

#include <memory>
#include <vector>

#include "support/sheet.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

constexpr double h = 0.01;  // of a step [s]

double stiffness_of(double limit) { return 5 / (limit - 1); }

class KeyedStretchLimitTest : public testing::Test {
 protected:
  KeyedStretchLimitTest()
      : mesh_(test::flat_sheet(3, 2, 0.3, 0.2)),
        shell_(build_shell(mesh_, mesh_.positions, {Vec3::UnitX()})) {}

  KeyedStretchLimit load(KeyedNumber limit) const {
    return {"cloth", shell_, std::move(limit), stiffness_of};
  }
  std::vector<Vec3> stretched(double ratio) const {
    std::vector<Vec3> x = mesh_.positions;
    for (Vec3& p : x) p.x() *= ratio;
    return x;
  }
  /// Expects the energy of a step that begins at `positions` and ends at time `end` to have the limit
  /// `expected`; returns the history after it.
  History step(const KeyedStretchLimit& load, const std::vector<Vec3>& positions, double end,
               const History& before, double expected) const {
    StepContext context;
    context.time_begin = end - h, context.time_end = end;
    context.length = context.dt = h;
    context.positions = positions;
    context.history = &before;
    const std::unique_ptr<Potential> energy = load.potential(context);
    const StretchLimitEnergy reference(shell_, expected, stiffness_of(expected));
    const std::vector<Vec3> far = stretched(1.5);
    EXPECT_NEAR(energy->value(far), reference.value(far), 1e-9 * reference.value(far)) << expected;
    History after = before;
    load.end_step(*energy, far, after);
    return after;
  }

  Mesh mesh_;
  Shell shell_;
};

KeyedNumber stepping(double first, double last) {
  KeyedNumber number;
  number.keys = {{0, first, Interpolation::step}, {1, last}};
  return number;
}

TEST_F(KeyedStretchLimitTest, GrowsAtOnce) {
  const KeyedStretchLimit limit = load(stepping(1.05, 1.3));
  const std::vector<Vec3> x = stretched(1.04);
  const History before = step(limit, x, 0.5, {}, 1.05);
  step(limit, x, 1, before, 1.3);
}

TEST_F(KeyedStretchLimitTest, ShrinksAtOnceWhereTheClothIsBelowItsOnset) {
  const KeyedStretchLimit limit = load(stepping(1.3, 1.05));
  const std::vector<Vec3> x = stretched(1.024);
  const History before = step(limit, x, 0.5, {}, 1.3);
  step(limit, x, 1, before, 1.05);
}

TEST_F(KeyedStretchLimitTest, FollowsStretchedClothByItsLengthPerSecond) {
  const KeyedStretchLimit limit = load(stepping(1.3, 1.05));
  const std::vector<Vec3> x = stretched(1.1);
  History history = step(limit, x, 0.5, {}, 1.3);
  history = step(limit, x, 1, history, 1.2 - h);  // from where 1.1 is the onset
  for (int i = 2; i < 15; ++i) history = step(limit, x, 1 + i * h, history, 1.2 - i * h);
  history = step(limit, x, 1.2, history, 1.06 - h);
  history = step(limit, x, 1.21, history, 1.05);
  step(limit, x, 0.9, history, 1.3);
}

TEST_F(KeyedStretchLimitTest, FollowsSlowKeyframesExactly) {
  KeyedNumber slow;
  slow.keys = {{0, 1.3}, {1, 1.1}};
  const KeyedStretchLimit limit = load(slow);
  const std::vector<Vec3> x = stretched(1.2);
  History history;
  for (int i = 1; i < 10; ++i) history = step(limit, x, i * h, history, 1.3 - 0.2 * i * h);
}

TEST_F(KeyedStretchLimitTest, IsTheConstantLimitBitForBitOnceThere) {
  const KeyedStretchLimit limit = load(stepping(1.3, 1.05));
  StepContext context;
  context.time_end = 2;
  const std::vector<Vec3> x = stretched(1.1);
  context.positions = x;
  const StretchLimitEnergy reference(shell_, 1.05, stiffness_of(1.05));
  EXPECT_EQ(test::gradient(*limit.potential(context), x), test::gradient(reference, x));
}

TEST_F(KeyedStretchLimitTest, OfOneIsAnError) { EXPECT_THROW(load(stepping(1.3, 1)), Error); }

}  // namespace
}  // namespace muslin
