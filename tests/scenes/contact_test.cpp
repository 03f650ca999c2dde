// The scenes of contact: facts that hold whatever the numbers, and that nothing crosses anything in any step,
// as the exact referee says. Shorter and coarser than the scenes where that is quick; `muslin verify` runs
// them in full.
#include <cmath>

#include "support/scene_run.hpp"
#include "verify_referee.hpp"
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace muslin::test {
namespace {

/// A scene whose steps are all looked at.
class Watched : public SceneRun {
 public:
  explicit Watched(const std::string& name, const std::vector<std::string>& overrides = {})
      : SceneRun("contact/" + name + ".toml", overrides), referee_(std::make_shared<const Model>(model())) {
    EXPECT_EQ(referee_.crossings(now()), 0U) << "at the start";
  }

  /// Runs to the time [s]; false, with a failure, at the first step where something crosses or touches.
  bool until(double time) {
    while (simulation().state().time < time - 1e-9) {
      step();
      const std::size_t found = referee_.crossings(now());
      const double least = simulation().diagnostics().min_distance;
      if (found == 0 && least > 0) continue;
      ADD_FAILURE() << found << " crossings, min_distance " << least << " m at " << simulation().state().time
                    << " s";
      return false;
    }
    return true;
  }

  const Component& body(const std::string& name) const {
    for (const Component& body : model().bodies)
      if (body.name == name) return body;
    throw std::invalid_argument("no body " + name);
  }
  ConstVectors points(const std::string& name) const { return model().of(body(name), now()); }
  Vec3 middle(const std::string& name) const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& x : points(name)) sum += x;
    return sum / static_cast<double>(points(name).size());
  }
  double highest(const std::string& name) const {
    double y = -INFINITY;
    for (const Vec3& x : points(name)) y = std::max(y, x.y());
    return y;
  }
  double lowest(const std::string& name) const {
    double y = INFINITY;
    for (const Vec3& x : points(name)) y = std::min(y, x.y());
    return y;
  }
  /// Mean speed of the body's vertices [m/s].
  double speed(const std::string& name) const {
    double sum = 0;
    const ConstVectors all = model().of(body(name), simulation().state().velocities);
    for (const Vec3& v : all) sum += v.norm();
    return sum / static_cast<double>(all.size());
  }

 private:
  app::Referee referee_;
};

const std::string coarse = "body.cloth.mesh=../meshes/cloth_coarse.obj";

TEST(SphereDrop, ClothLiesOnTheBallAndHangsBelowItsTop) {
  Watched run("sphere_drop", {coarse});
  ASSERT_TRUE(run.until(0.8));
  EXPECT_NEAR(run.probe("middle").y(), 0.8, 0.005);  // the top of the ball
  EXPECT_LT(run.probe("corner").y(), 0.5);
  EXPECT_LT(run.highest("cloth"), 0.81);
  EXPECT_LT(run.simulation().diagnostics().max_stretch, 1.2);
}

TEST(FoldOnFloor, LiesInFoldsOnTheFloor) {
  Watched run("fold_on_floor", {coarse});
  ASSERT_TRUE(run.until(0.9));
  EXPECT_GT(run.lowest("cloth"), 0);
  EXPECT_LT(run.highest("cloth"), 0.5);
}

TEST(RotatingSphere, DragsTheClothAlong) {
  Watched run("rotating_sphere", {coarse});
  ASSERT_TRUE(run.until(1.2));
  const auto angle = [&] { return std::atan2(-run.probe("on the ball").z(), run.probe("on the ball").x()); };
  EXPECT_NEAR(angle(), 0, 0.1);
  ASSERT_TRUE(run.until(1.8));  // the ball has turned by a right angle
  EXPECT_GT(angle(), 0.7);
  EXPECT_LT(angle(), 1.7);
}

TEST(Funnel, SheetsRestInTheOrderInWhichTheyFell) {
  Watched run("funnel");
  ASSERT_TRUE(run.until(1));
  const auto lowest = [&](const char* sheet) {
    double y = INFINITY;
    for (const Vec3& x : run.points(sheet)) y = std::min(y, x.y());
    return y;
  };
  EXPECT_LT(lowest("first"), lowest("second"));
  EXPECT_LT(lowest("second"), lowest("third"));
  EXPECT_LT(run.probe("middle of the third").y(), 0.15);  // down from 0.59, in the lower half
}

TEST(TwistedCylinder, NarrowsAsItTwists) {
  Watched run("twisted_cylinder");
  const auto width = [&] { return (run.probe("middle above") - run.probe("middle below")).norm(); };
  EXPECT_NEAR(width(), 0.16, 1e-3);
  ASSERT_TRUE(run.until(1));
  EXPECT_LT(width(), 0.12);
  EXPECT_LT(run.simulation().diagnostics().max_stretch, 1.25);
}

TEST(ReefKnot, HoldsWhenItIsPulled) {
  Watched run("reef_knot", {"pin.0.keyframes=[{ time = 0 }, { time = 0.8, translate = [-0.27, 0, 0] }]",
                            "pin.1.keyframes=[{ time = 0 }, { time = 0.8, translate = [0.27, 0, 0] }]"});
  // Length by which the bights reach through one another.
  const auto overlap = [&] {
    double left = -INFINITY, right = INFINITY;
    for (const Vec3& x : run.points("left")) left = std::max(left, x.x());
    for (const Vec3& x : run.points("right")) right = std::min(right, x.x());
    return left - right;
  };
  const double loose = overlap();
  EXPECT_GT(loose, 0.3);
  ASSERT_TRUE(run.until(0.8));
  EXPECT_GT(overlap(), 0);  // still linked, though the hands went apart by half a metre
  EXPECT_LT(overlap(), 0.6 * loose);
}

TEST(StackUnderBall, StaysInOrderUnderTheBall) {
  Watched run("stack_under_ball", {"collider.ball.center=[0.03, 0.13, 0.02]"});
  ASSERT_TRUE(run.until(0.125));
  const auto height = [&](int i) { return run.probe(fmt::format("middle of sheet {}", i)).y(); };
  for (int i = 1; i < 10; ++i) EXPECT_LT(height(i), height(i + 1)) << i;
  EXPECT_GT(height(1), 0);
  EXPECT_LT(run.middle("ball").y(), 0.11);  // it has fallen on the stack
  EXPECT_GT(run.middle("ball").y(), 0.06);  // its radius
}

TEST(FlagBall, CatchesTheBallWhichRolls) {
  Watched run("flag_ball");
  ASSERT_TRUE(run.until(1.5));
  EXPECT_TRUE(run.held_are_still());
  EXPECT_LT(run.probe("centre").y(), -0.3);
  const Vec3 first = run.middle("ball");
  EXPECT_LT(first.y(), 0.7);
  ASSERT_TRUE(run.until(3));
  const Vec3 then = run.middle("ball");
  EXPECT_GT(then.y(), -3);                // caught
  EXPECT_GT((then - first).norm(), 0.5);  // and rolling
  EXPECT_GT(run.simulation().diagnostics().min_distance, 0);
}

TEST(FlagOnPole, SlidesOffWithLowFrictionAndStaysWithHigh) {
  // It lies 3 m to one side and 7 m to the other: friction holds it if exp(mu pi) is above their ratio.
  Watched smooth("flag_on_pole"), rough("flag_on_pole", {"contact.friction=0.6"});
  ASSERT_TRUE(smooth.until(3));
  EXPECT_LT(smooth.highest("flag"), -1);  // below the pole
  ASSERT_TRUE(rough.until(3));
  EXPECT_GT(rough.highest("flag"), -0.2);  // over it
}

TEST(LatticeOnStairs, ComesToRestOnAStep) {
  Watched run("lattice_on_stairs", {"body.bear.voxel_width=0.01"});
  ASSERT_TRUE(run.until(2));
  EXPECT_LT(run.speed("bear"), 0.05);
  double lowest = INFINITY;
  std::vector<Vec3> skin(run.body("bear").mesh.positions.size());
  run.body("bear").skin.apply(run.points("bear"), skin);
  for (const Vec3& x : skin) lowest = std::min(lowest, x.y());
  const double step = std::round(lowest / -0.07);
  EXPECT_GE(step, 1);
  EXPECT_LE(step, 5);
  EXPECT_NEAR(lowest, -0.07 * step, 0.003);
}

TEST(CurtainWalk, PanelsArePushedAside) {
  Watched run("curtain_walk");
  const auto farthest = [&] {
    double z = -INFINITY;
    for (const char* name : {"left", "right"})
      for (const Vec3& x : run.points(name)) z = std::max(z, x.z());
    return z;
  };
  const double before = farthest();
  ASSERT_TRUE(run.until(1.25));
  EXPECT_GT(farthest(), before + 0.1);
  ASSERT_TRUE(run.until(2.2));
  EXPECT_LT(run.simulation().diagnostics().max_stretch, 1.4);
  EXPECT_EQ(run.simulation().diagnostics().held_back, 0) << "vertices of the walker are caught";
  EXPECT_TRUE(run.held_are_still());
}

}  // namespace
}  // namespace muslin::test
