// run_scene: a scene file to a run directory, stopped and resumed.
#include "muslin/cache/run.hpp"

#include <cmath>
#include <fstream>
#include <memory>
#include <string>

#include "cache/scratch.hpp"
#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "muslin/cache/run_reader.hpp"
#include "muslin/component/shell/shell_body_settings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"

namespace muslin {
namespace {

using test::bytes_of;
using test::Scratch;

const std::filesystem::path scene =
    std::filesystem::path(MUSLIN_SOURCE_DIR) / "scenes" / "thesis" / "2_two_corners.toml";

RunOptions options(const std::filesystem::path& directory, int frames) {
  RunOptions options;
  options.directory = directory;
  options.frames = frames;
  return options;
}

TEST(Run, WritesTheThesisFlagAndReportsProgress) {
  Scratch scratch;
  RunOptions asked = options(scratch / "run", 4);
  std::vector<RunProgress> reports;
  asked.report = [&](const RunProgress& progress) { reports.push_back(progress); };
  const RunResult result = run_scene(scene, asked);
  EXPECT_EQ(result.first_frame, 0);
  EXPECT_EQ(result.last_frame, 4);
  ASSERT_FALSE(reports.empty());
  EXPECT_EQ(reports.back().frame, 4);
  EXPECT_EQ(reports.back().fraction, 1);
  EXPECT_EQ(reports.back().seconds_left, 0);
  const RunReader run(scratch / "run");
  EXPECT_EQ(run.status(), RunStatus::finished);
  EXPECT_EQ(run.frame_count(), 5);
  EXPECT_EQ(bytes_of(scratch / "run/scene.toml"), bytes_of(scene));
  const auto stats = nlohmann::json::parse(bytes_of(scratch / "run/stats.json"))["bodies"][0];
  EXPECT_EQ(stats["vertices"], 154);
  EXPECT_EQ(stats["springs"]["edge"], 349);
  EXPECT_NEAR(stats["mass"].get<double>(), 600, 1e-9);
  const Diagnostics& first = run.diagnostics()[0];
  for (const Diagnostics& row : run.diagnostics())
    EXPECT_NEAR(row.balance(), first.balance(), 1.0) << row.frame;  // of some 10 kJ
}

TEST(Run, SceneWithMeshesInMemoryGivesTheBytesOfFiles) {
  Scratch scratch;
  run_scene(scene, options(scratch / "file", 2));
  Scene own = parse_scene(read_file(scene), scene);
  own.meshes[own.bodies[0].mesh] = std::make_shared<const Mesh>(scene_mesh(own, own.bodies[0].mesh).mesh);
  own.file = scratch / "nowhere" / "2_two_corners.toml";
  run_scene(own, options(scratch / "own", 2));
  for (const char* file : {"flag.skin.obj", "flag.skin.pc2", "flag.lattice.pc2", "scene.toml"})
    EXPECT_EQ(bytes_of(scratch / "file" / file), bytes_of(scratch / "own" / file)) << file;
}

TEST(Run, InterruptedRunResumesToTheSameBytes) {
  Scratch scratch;
  run_scene(scene, options(scratch / "straight", 4));
  RunOptions stopped = options(scratch / "stopped", 4);
  bool stop = false;
  stopped.report = [&](const RunProgress& progress) { stop = progress.frame == 2; };
  stopped.cancelled = [&] { return stop; };
  try {
    run_scene(scene, stopped);
    FAIL() << "not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
    EXPECT_THAT(error.what(), testing::HasSubstr("--resume"));
  }
  EXPECT_EQ(RunReader(scratch / "stopped").status(), RunStatus::interrupted);
  RunOptions resumed = options(scratch / "stopped", 4);
  resumed.resume = true;
  EXPECT_EQ(run_scene(scene, resumed).first_frame, 2);
  for (const char* name : {"flag.skin.pc2", "flag.contour.pc2", "probes.csv", "checkpoint/000004.state"})
    EXPECT_EQ(bytes_of(scratch / "straight" / name), bytes_of(scratch / "stopped" / name)) << name;
}

TEST(Run, ResumesWithOtherForcesButNotWithOtherBodies) {
  Scratch scratch;
  run_scene(scene, options(scratch / "run", 2));
  RunOptions resumed = options(scratch / "run", 3);
  resumed.resume = true;
  resumed.overrides = {"time.duration=9"};
  EXPECT_THAT(run_scene(scene, resumed).changes, testing::ElementsAre("time.duration"));
  resumed.overrides = {"body.flag.voxel_width=0.5"};
  try {
    run_scene(scene, resumed);
    FAIL() << "resumed with another lattice";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_THAT(error.what(), testing::HasSubstr("body.0.voxel_width"));
  }
  EXPECT_EQ(RunReader(scratch / "run").frame_count(), 4);
}

TEST(Run, ADamagedSummaryIsAnErrorOnResume) {
  Scratch scratch;
  run_scene(scene, options(scratch / "run", 2));
  RunOptions resumed = options(scratch / "run", 4);
  resumed.resume = true;
  const auto sound = nlohmann::json::parse(bytes_of(scratch / "run/run.json"));
  for (const char* key : {"scene", "frame_rate", "timings"}) {
    auto damaged = sound;
    damaged[key] = "nonsense";
    std::ofstream(scratch / "run/run.json") << damaged.dump();
    try {
      run_scene(scene, resumed);
      FAIL() << key;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << key;
      EXPECT_THAT(error.what(), testing::HasSubstr("run.json: the summary of the run is damaged")) << key;
    }
  }
}

TEST(Run, ColoursAndTheTitleMayChangeOnResume) {
  Scratch scratch;
  run_scene(scene, options(scratch / "run", 2));
  RunOptions resumed = options(scratch / "run", 4);
  resumed.resume = true;
  resumed.overrides = {"title=\"Another\"", "body.flag.colour=[0.1, 0.2, 0.3]"};
  EXPECT_EQ(run_scene(scene, resumed).first_frame, 2);
  const RunReader run(scratch / "run");
  EXPECT_EQ(run.frame_count(), 5);
  EXPECT_EQ(run.title(), "Another");
  EXPECT_NEAR(run.colour(0).y(), 0.2, 1e-12);
}

TEST(Run, ResumesFromAnyFrameWithAKeptState) {
  Scratch scratch;
  run_scene(scene, options(scratch / "straight", 6));
  RunOptions kept = options(scratch / "run", 6);
  kept.keep_states = true;
  run_scene(scene, kept);
  kept.resume = true;
  kept.resume_from = 2;
  EXPECT_EQ(run_scene(scene, kept).first_frame, 2);
  for (const char* name : {"flag.skin.pc2", "flag.contour.pc2", "flag.lattice.pc2", "probes.csv"})
    EXPECT_EQ(bytes_of(scratch / "run" / name), bytes_of(scratch / "straight" / name)) << name;

  // With another gravity the frames up to there stay, those behind it differ, and none of the old is left.
  kept.frames = 4;
  kept.resume_from = 3;
  kept.overrides = {"force.0.acceleration=[0, 9.8, 0]"};
  const RunResult changed = run_scene(scene, kept);
  EXPECT_EQ(changed.first_frame, 3);
  EXPECT_EQ(changed.last_frame, 4);
  const RunReader before(scratch / "straight"), after(scratch / "run");
  ASSERT_EQ(after.frame_count(), 5);
  EXPECT_EQ(after.diagnostics()[3].kinetic, before.diagnostics()[3].kinetic);
  EXPECT_NE(after.diagnostics()[4].kinetic, before.diagnostics()[4].kinetic);
  kept.resume_from = 5;
  EXPECT_THROW(
      {
        try {
          run_scene(scene, kept);
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::input);
          EXPECT_THAT(error.what(), testing::HasSubstr("4, 3, 2, 1, 0"));
          throw;
        }
      },
      Error);
  kept.directory = scratch / "nothing";
  EXPECT_THROW(run_scene(scene, kept), Error);
}

/// A sheet whose two held sides move apart by this share of its width in six frames.
Scene pulled(double apart) {
  Scene scene = parse_scene(R"([time]
duration = 0.25
frame_rate = 24
steps_per_frame = 2
[[body]]
name = "cloth"
mesh = "sheet.obj"
model = "shell"
stretch_limit = 1.05
material = { areal_density = 0.15, membrane_warp = 100, bending_warp = 1e-5 }
[[pin]]
name = "left"
where = { plane = { point = [0, 0, 0], normal = [1, 0, 0], distance = 0.01 } }
[[pin]]
name = "right"
where = { plane = { point = [1, 0, 0], normal = [1, 0, 0], distance = 0.01 } }
keyframes = [{ time = 0 }, { time = 0.25, translate = [)" +
                                std::to_string(apart) + ", 0, 0] }]\n",
                            "scene.toml");
  scene.meshes["sheet.obj"] = std::make_shared<Mesh>(test::flat_sheet(4, 4, 1, 1));
  return scene;
}

TEST(Run, WarnsOfAStretchLimitThatPinsOverride) {
  Scratch scratch;
  const auto of_limit =
      testing::AllOf(testing::HasSubstr("body cloth"), testing::HasSubstr("`stretch_limit` of 1.05"));
  const RunResult straight = run_scene(pulled(0.5), options(scratch / "straight", 6));
  EXPECT_THAT(straight.warnings, testing::Contains(testing::AllOf(
                                     of_limit, testing::HasSubstr("at the end of frames 1 to 6;"))));
  const auto summary = [&](const char* run) {
    return nlohmann::json::parse(bytes_of(scratch / run / "run.json"));
  };
  const auto run = summary("straight");
  EXPECT_EQ(run["warnings"], nlohmann::json(straight.warnings));
  ASSERT_EQ(run["overstretched"].size(), 1u);
  EXPECT_EQ(run["overstretched"][0]["body"], "cloth");
  EXPECT_EQ(run["overstretched"][0]["limit"], 1.05);
  EXPECT_GE(run["overstretched"][0]["stretch"].get<double>(), 1.5);

  run_scene(pulled(0.5), options(scratch / "stopped", 3));
  RunOptions resumed = options(scratch / "stopped", 6);
  resumed.resume = true;
  const RunResult again = run_scene(pulled(0.5), resumed);
  EXPECT_EQ(again.first_frame, 3);
  EXPECT_EQ(again.warnings, straight.warnings);
  EXPECT_EQ(summary("stopped")["overstretched"], run["overstretched"]);
  EXPECT_EQ(bytes_of(scratch / "stopped/stretch.csv"), bytes_of(scratch / "straight/stretch.csv"));

  // Within the limit nothing is said.
  const RunResult honest = run_scene(pulled(0.03), options(scratch / "honest", 6));
  EXPECT_THAT(honest.warnings, testing::Not(testing::Contains(of_limit)));
  EXPECT_TRUE(summary("honest")["overstretched"].empty());
}

TEST(Run, StretchLimitMayBeAddedOnResume) {
  Scratch scratch;
  Scene weak = pulled(0.5);
  weak.bodies[0].own.as<ShellBodySettings>().stretch_limit.reset();
  run_scene(weak, options(scratch / "run", 3));
  EXPECT_FALSE(std::filesystem::exists(scratch / "run/stretch.csv"));
  RunOptions resumed = options(scratch / "run", 6);
  resumed.resume = true;
  EXPECT_THAT(run_scene(pulled(0.5), resumed).warnings,
              testing::Contains(testing::HasSubstr("at the end of frames 4 to 6;")));
  EXPECT_THAT(bytes_of(scratch / "run/stretch.csv"), testing::StartsWith("frame,stretch,limit,body\n4,"));
}

}  // namespace
}  // namespace muslin
