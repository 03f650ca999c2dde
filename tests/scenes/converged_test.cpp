// Exact contact from outside: `muslin run --set solver.effort=exact` takes the scenes of contact through
// their first touches with steps of up to 1/48 s, solves every step to the tolerance, and after none of them
// the exact referee finds a crossing. That the scenes need contact shows in the same runs without it, which
// do cross; that the error tells how well steps are solved shows in drafts, which leave more.
#include <algorithm>
#include <cmath>
#include <ostream>

#include "apps/program.hpp"
#include "verify_referee.hpp"
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "muslin/cache/run_files.hpp"
#include "muslin/simulation/run_state.hpp"

namespace muslin::test {
namespace {

struct Touch {
  const char* scene;
  int steps_per_second;
  int steps;
  int touching;  ///< steps, of these, at whose end surfaces are within the contact distance; at least
  std::vector<std::string> overrides;  ///< coarser, and closer to the first touch
};

std::ostream& operator<<(std::ostream& out, const Touch& touch) { return out << touch.scene; }

class FirstTouch : public testing::TestWithParam<Touch> {
 protected:
  /// Every step of the run: its rows of diagnostics, and the crossings of the exact state.
  struct Watched {
    std::vector<Diagnostics> rows;
    std::vector<std::size_t> crossings;
  };

  /// The scene with a frame a step.
  static std::vector<std::string> overrides_of(const Touch& touch) {
    std::vector<std::string> all = touch.overrides;
    all.push_back(fmt::format("time.frame_rate={}", touch.steps_per_second));
    all.emplace_back("time.steps_per_frame=1");
    return all;
  }
  static std::string file_of(const Touch& touch) {
    return (scenes / "contact" / fmt::format("{}.toml", touch.scene)).string();
  }

  /// Runs the program; the states are those of its checkpoints, which it keeps in double.
  Watched watch(const Touch& touch, const std::vector<std::string>& more) {
    const auto directory = scratch_ / "run";
    std::vector<std::string> words = {"run",       file_of(touch),
                                      "-o",        directory.string(),
                                      "--frames",  std::to_string(touch.steps),
                                      "--quiet",   "--keep-states",
                                      "--threads", "1"};
    std::vector<std::string> all = overrides_of(touch);
    all.insert(all.end(), more.begin(), more.end());
    for (const std::string& setting : all) words.insert(words.end(), {"--set", setting});
    const Outcome outcome = run(scratch_, words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (outcome.code != 0) return {};

    Watched watched{RunReader(directory).diagnostics(), {}};
    std::vector<CheckpointFile> states = list_checkpoints(directory);
    std::reverse(states.begin(), states.end());
    for (const CheckpointFile& file : states) {
      const std::string bytes = bytes_of(file.path);
      const std::vector<std::uint8_t> saved(bytes.begin(), bytes.end());
      watched.crossings.push_back(
          referee_.crossings(from_checkpoint(saved, model_->rest_positions.size()).motion.positions));
    }
    EXPECT_EQ(watched.rows.size(), static_cast<std::size_t>(touch.steps) + 1);
    EXPECT_EQ(watched.crossings.size(), watched.rows.size());
    return watched;
  }

  const std::string exact_ = "solver.effort=exact";
  const Scratch scratch_;
  const std::shared_ptr<const Model> model_ =
      std::make_shared<const Model>(build_model(read_scene(file_of(GetParam()), overrides_of(GetParam()))));
  const app::Referee referee_{model_};
};

class ExactContact : public FirstTouch {};

TEST_P(ExactContact, ConvergesInEveryStepWithoutCrossings) {
  const Touch& touch = GetParam();
  const Watched watched = watch(touch, {exact_});
  int touching = 0;
  for (std::size_t i = 0; i < watched.rows.size(); ++i) {
    const Diagnostics& row = watched.rows[i];
    EXPECT_EQ(row.converged_steps, row.steps) << "step " << i;
    EXPECT_GT(row.min_distance, 0) << "step " << i;
    EXPECT_EQ(watched.crossings[i], 0U) << "step " << i;
    if (std::isfinite(row.min_distance)) ++touching;
  }
  EXPECT_GE(touching, touch.touching);
}

TEST_P(ExactContact, SameStepsCrossWithoutContact) {
  std::vector<std::string> none;
  for (std::size_t b = 0; b < model_->scene.bodies.size(); ++b)
    none.push_back(fmt::format("body.{}.contact=false", b));
  const Watched watched = watch(GetParam(), none);
  EXPECT_GT(std::count_if(watched.crossings.begin(), watched.crossings.end(), [](auto n) { return n > 0; }),
            0);
}

class DraftContact : public FirstTouch {};

TEST_P(DraftContact, HasLargerErrorsThanExactContact) {
  const auto largest = [&](const std::string& effort) {
    double error = 0;
    for (const Diagnostics& row : watch(GetParam(), {effort}).rows) error = std::max(error, row.error);
    return error;
  };
  EXPECT_GT(largest("solver.effort=draft"), largest(exact_));
}

const std::string coarse = "body.cloth.mesh=../meshes/cloth_coarse.obj";

const std::vector<Touch> touches = {

    // Falls on the ball and wraps it.
    {"sphere_drop", 120, 42, 30, {coarse}},
    // Stands on the floor, buckles, and folds up over itself, vertex on vertex.
    {"fold_on_floor", 120, 48, 36, {coarse}},
    // Falls on the ball, which turns under it: friction at work.
    {"rotating_sphere",
     120,
     36,
     26,
     {coarse, "collider.ball.keyframes=[{ time = 0.1 }, { time = 0.3, rotate = [0, 40, 0] }]"}},
    // A lattice lies down on a capsule.
    {"flag_on_pole", 48, 40, 35, {}},
    // A lattice catches a rigid body that moves.
    {"flag_ball", 48, 20, 12, {"collider.ball.center=[3.5, 1, 2.6]"}},
    // A solid lattice on the edges of a mesh.
    {"lattice_on_stairs", 120, 20, 10, {"body.bear.voxel_width=0.01"}},
    // Silk falls into a mesh with 2 m/s.
    {"funnel",
     120,
     36,
     10,
     {"body.first.velocity=[0, -2, 0]", "body.second.velocity=[0, -2, 0]", "body.third.velocity=[0, -2, 0]"}},
    // Sheets settle on one another, a ball on the uppermost.
    {"stack_under_ball", 240, 9, 4, {"collider.ball.center=[0.03, 0.104, 0.02]"}},
    // A mesh that moves pushes two sheets.
    {"curtain_walk", 240, 15, 5, {"collider.walker.translate=[0, 0.05, -0.3]"}}};

const auto scene_of = [](const auto& info) { return std::string(info.param.scene); };

INSTANTIATE_TEST_SUITE_P(Scenes, ExactContact, testing::ValuesIn(touches), scene_of);
INSTANTIATE_TEST_SUITE_P(Scenes, DraftContact, testing::Values(touches.front()), scene_of);

}  // namespace
}  // namespace muslin::test
