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
  explicit Watched(const std::string& name, std::vector<std::string> overrides = {})
      : SceneRun("contact/" + name + ".toml", overrides = with_steps_as_frames(name, overrides)),
        referee_(std::make_shared<const Model>(model())) {
    EXPECT_EQ(referee_.crossings(now()), 0U) << "at the start";
  }

  /// Runs to the time [s]; false, with a failure, at the first step where something crosses or touches.
  bool until(double time) {
    while (simulation().state().time < time - 1e-9) {
      until_frame(simulation().frame() + 1);
      const std::size_t found = referee_.crossings(now());
      const double least = simulation().diagnostics().min_distance;
      if (found == 0 && least > 0) continue;
      ADD_FAILURE() << found << " crossings, min_distance " << least << " m at " << simulation().state().time << " s";
      return false;
    }
    return true;
  }

  const Body& body(const std::string& name) const {
    for (const Body& body : model().bodies)
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
  static std::vector<std::string> with_steps_as_frames(const std::string& name, std::vector<std::string> overrides) {
    const std::string file = std::string(MUSLIN_SOURCE_DIR) + "/scenes/contact/" + name + ".toml";
    const TimeSettings time = read_scene(file, overrides).time;
    overrides.push_back(fmt::format("time.frame_rate={:.17g}", time.frame_rate * time.steps_per_frame));
    overrides.push_back("time.steps_per_frame=1");
    return overrides;
  }
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

}  // namespace
}  // namespace muslin::test
