// The run directory: its files, and that a run which was killed, stopped or ran out of disk goes on to the
// same bytes as one that never was.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <map>
#include <thread>

#include "cache/scratch.hpp"
#include "support/small_model.hpp"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "muslin/cache/run_files.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/cache/run_writer.hpp"
#include "muslin/component/lattice/lattice_body.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/output_file.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Scratch;
using test::small_model;
using testing::HasSubstr;

std::shared_ptr<const Model> model() {
  test::SmallModelOptions options;
  options.tolerance = 1e-4;
  return std::make_shared<const Model>(small_model(options));
}

void run_to(const fs::path& directory, int frames, bool resume, bool finish = true) {
  Simulation simulation(model());
  RunWriter writer(directory, simulation, frames, resume);
  while (simulation.frame() < frames) {
    simulation.advance();
    writer.write_frame();
  }
  if (finish) writer.finish(RunStatus::finished);
}

/// All files by name. Times of the wall clock are left out: the last column of the diagnostics, and the
/// timings in run.json.
std::map<std::string, std::string> contents(const fs::path& directory) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(directory)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = fs::relative(entry.path(), directory).string();
    std::string content = bytes_of(entry.path());
    if (name == "diagnostics.csv") {
      content = test::without_wall_times(content);
    } else if (name == "run.json") {
      auto json = nlohmann::json::parse(content);
      json.erase("timings");
      content = json.dump();
    }
    files[name] = content;
  }
  return files;
}

void expect_same_run(const fs::path& a, const fs::path& b) {
  const auto left = contents(a), right = contents(b);
  for (const auto& [name, content] : left) {
    ASSERT_TRUE(right.contains(name)) << name;
    EXPECT_TRUE(content == right.at(name)) << name << " differs";
  }
  EXPECT_EQ(left.size(), right.size());
}

template <class Body>
void expect_error(ErrorKind kind, const std::string& words, const Body& body) {
  try {
    body();
    FAIL() << "no error: " << words;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

TEST(RunQuality, NamesConsecutiveFramesAsRanges) {
  EXPECT_EQ(describe_frames({3}), "frame 3");
  EXPECT_EQ(describe_frames({12, 13, 14, 15, 20}), "frames 12 to 15 and 20");
  EXPECT_EQ(describe_frames({1, 3, 4, 9}), "frames 1, 3 to 4 and 9");
  std::vector<int> odd;
  for (int f = 1; f < 41; f += 2) odd.push_back(f);
  EXPECT_EQ(describe_frames(odd), "frames 1, 3, 5, 7, 9, 11, 13, 15 and 12 more");
}

TEST(RunQuality, WarnsOfMissedTolerancesHeldBackVerticesAndCrossings) {
  RunQuality quality;
  Diagnostics row;
  row.steps = row.converged_steps = 200;
  for (row.frame = 1; row.frame < 10; ++row.frame) quality.add(row);
  EXPECT_THAT(warnings_of(quality), testing::IsEmpty());
  row.frame = 10, row.converged_steps = 199, row.error = 1e-3;
  quality.add(row);
  EXPECT_THAT(warnings_of(quality),
              testing::ElementsAre(HasSubstr("1 of 2000 steps missed their tolerance, in frame 10")));
  row.frame = 11, row.converged_steps = 200, row.error = 0;
  quality.add(row);
  EXPECT_THAT(warnings_of(quality), testing::IsEmpty()) << "few, and not at the end";
  row.frame = 12, row.converged_steps = 100, row.held_back = 3, row.behind = 0.0042, row.crossings = 2;
  quality.add(row);
  EXPECT_THAT(warnings_of(quality), testing::ElementsAre(HasSubstr("in frames 10 and 12"),
                                                         HasSubstr("by up to 4.2 mm; they still are behind"),
                                                         HasSubstr("2 pairs of triangles still cross")));
}

TEST(RunQuality, WarnsOfExceededStretchLimits) {
  RunQuality quality;
  quality.add(LimitedStretch{0, 1, 1.05, "hem"});
  quality.add(LimitedStretch{1, 1.059, 1.05, "hem"});
  quality.add(LimitedStretch{1, 1.15, 1.1, "sail"});
  EXPECT_THAT(warnings_of(quality), testing::ElementsAre(HasSubstr("body sail: ")));
  for (int frame = 2; frame < 5; ++frame) quality.add(LimitedStretch{frame, 4.3 - 0.5 * frame, 1.05, "hem"});
  quality.add(LimitedStretch{7, 1.2, 1.05, "hem"});
  EXPECT_THAT(
      warnings_of(quality),
      testing::ElementsAre(
          testing::AllOf(HasSubstr("up to 1.15 times as long as at rest, beyond its `stretch_limit` of 1.1"),
                         HasSubstr("at the end of frame 1; ")),
          testing::AllOf(HasSubstr("body hem: a triangle was up to 3.3 times as long as at rest, beyond its "
                                   "`stretch_limit` of 1.05, at the end of frames 2 to 4 and 7; move pins"),
                         HasSubstr("raise `stretch_limit`"))));
  RunQuality from_start;
  from_start.add(LimitedStretch{0, 1.3, 1.05, "hem"});
  EXPECT_THAT(warnings_of(from_start),
              testing::ElementsAre(HasSubstr("it starts beyond the limit: check `rest_mesh`")));
  RunQuality falling;
  falling.add(LimitedStretch{0, 1.15, 1.2, "hem"});
  falling.add(LimitedStretch{1, 1.15, 1.05, "hem"});
  EXPECT_THAT(warnings_of(falling), testing::ElementsAre(HasSubstr("let `stretch_limit` fall more slowly")));
}

TEST(RunDirectory, ResumesWithATableOfAnEarlierVersion) {
  for (const int columns : {16, 23}) {
    SCOPED_TRACE(columns);
    Scratch scratch;
    run_to(scratch / "run", 3, false);
    const std::string table = bytes_of(scratch / "run/diagnostics.csv");
    std::string old;
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);) {
      std::size_t end = 0;
      for (int i = 0; i < columns; ++i) end = line.find(',', end + 1);
      old += line.substr(0, end) + "\n";
    }
    test::write_bytes(scratch / "run/diagnostics.csv", old);
    const auto rows = RunReader(scratch / "run").diagnostics();
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_GT(rows[3].wall_ms, 0);
    EXPECT_EQ(rows[3].steps > 0, columns > 16);
    run_to(scratch / "run", 5, true);
    const auto more = RunReader(scratch / "run").diagnostics();
    ASSERT_EQ(more.size(), 6u);
    EXPECT_EQ(more[3].steps, rows[3].steps);
    EXPECT_EQ(more[3].kinetic, rows[3].kinetic);
    EXPECT_GT(more[5].steps, 0);
    std::int64_t steps = 0;
    for (const auto& row : more) steps += row.steps;
    const auto run = nlohmann::json::parse(bytes_of(scratch / "run/run.json"));
    EXPECT_EQ(run["convergence"]["steps"], steps);
    EXPECT_THAT(bytes_of(scratch / "run/diagnostics.csv"), HasSubstr("penetration,behind\n"));
  }
}

TEST(RunDirectory, HasTheDocumentedFiles) {
  Scratch scratch;
  run_to(scratch / "run", 5, false);
  for (const char* name : {"run.json", "scene.toml", "stats.json", "flag.skin.obj", "flag.skin.pc2",
                           "flag.contour.obj", "flag.contour.pc2", "diagnostics.csv", "probes.csv",
                           "checkpoint/000005.state", "checkpoint/000004.state"})
    EXPECT_TRUE(fs::exists(scratch / "run" / name)) << name;
  EXPECT_FALSE(fs::exists(scratch / "run/checkpoint/000003.state"));
  EXPECT_THAT(
      bytes_of(scratch / "run/diagnostics.csv"),
      testing::StartsWith("frame,time,kinetic,elastic,potential,work,dissipated,momentum_x,momentum_y,"
                          "momentum_z,newton_iterations,linear_iterations,residual,max_stretch,"
                          "min_distance,wall_ms,steps,converged_steps,error,unbalanced,crossings,"
                          "held_back,penetration,behind\n0,0,0,0,"));
  EXPECT_THAT(bytes_of(scratch / "run/diagnostics.csv"), HasSubstr(",inf,"));
  EXPECT_THAT(bytes_of(scratch / "run/probes.csv"),
              testing::StartsWith("frame,time,name,x,y,z,vx,vy,vz\n0,0,tip,1.5,0,0.5,0,0,0\n1,"));
  const auto stats = nlohmann::json::parse(bytes_of(scratch / "run/stats.json"))["bodies"][0];
  EXPECT_EQ(stats["springs"]["face_diagonal"], 23);
  EXPECT_EQ(stats["mass"], 60.0);
  const auto run = nlohmann::json::parse(bytes_of(scratch / "run/run.json"));
  EXPECT_EQ(run["status"], "finished");
  EXPECT_EQ(run["scene"]["title"], "a small flag");
}

/// The first runs listed no files, later ones did not say that the vertices of a lattice are cached.
TEST(RunDirectory, OfEarlierVersionsIsReadAndReplaced) {
  Scratch scratch;
  const fs::path directory = scratch / "run";
  run_to(directory, 1, false);
  auto summary = nlohmann::json::parse(bytes_of(directory / "run.json"));
  EXPECT_EQ(summary["bodies"][0]["vertices"], "lattice");
  const auto expect_read = [&] {
    write_atomically(directory / "run.json", summary.dump());
    const RunReader run(directory);
    EXPECT_TRUE(run.has(0, SurfaceKind::contour));
    EXPECT_EQ(run.cells(0).rest_positions, model()->rest_positions);
    EXPECT_EQ(run.selectable_count(0), model()->vertex_count());
  };
  summary["bodies"][0].erase("vertices");
  expect_read();
  summary["bodies"] = {{{"name", "flag"}}};
  expect_read();
  remove_run_files(directory);
  for (const char* file : {"flag.skin.pc2", "flag.contour.obj", "flag.lattice.vtu", "flag.lattice.pc2"})
    EXPECT_FALSE(fs::exists(directory / file)) << file;
}

TEST(RunDirectory, FilesOutsideOfTheRunAreNotThoseOfABody) {
  const auto entry = nlohmann::ordered_json::parse(R"({"name": "flag", "model": "x",
      "a": {"mesh": "../flag.a.obj", "cache": "flag.a.pc2"},
      "b": {"mesh": "flag.b.obj", "cache": "sail.b.pc2"},
      "c": {"mesh": "flag.c.obj", "cache": "flag.c.pc2"}, "d": 3, "vertices": "c"})");
  const BodyFiles files = listed_files(entry);
  ASSERT_EQ(files.points.size(), 2u);
  EXPECT_EQ(files.points[0].cache, "flag.skin.pc2");
  EXPECT_EQ(files.points[1].mesh, "flag.c.obj");
  EXPECT_EQ(files.vertices, "c");
}

TEST(RunDirectory, IsReadBack) {
  Scratch scratch;
  run_to(scratch / "run", 5, false);
  const RunReader run(scratch / "run");
  EXPECT_EQ(run.status(), RunStatus::finished);
  ASSERT_EQ(run.frame_count(), 6);
  EXPECT_EQ(run.frame_rate(), 24);
  EXPECT_EQ(run.find_body(""), 0);
  EXPECT_EQ(run.mesh(0, SurfaceKind::skin).face_vertices, model()->bodies[0].mesh.face_vertices);
  EXPECT_EQ(run.cells(0).voxels, as_lattice(model()->bodies[0])->lattice.voxel_vertices);
  EXPECT_EQ(run.cells(0).rest_positions, model()->rest_positions);
  Simulation simulation(model());
  for (int frame = 0; frame < 5; ++frame) simulation.advance();
  std::vector<Vec3> skin(8);
  model()->bodies[0].skin.apply(simulation.state().positions, skin);
  const auto points = run.points(0, SurfaceKind::skin, 5);
  for (std::size_t i = 0; i < skin.size(); ++i) EXPECT_EQ(points[i], skin[i].cast<float>());
  EXPECT_EQ(run.diagnostics()[5].dissipated, simulation.diagnostics().dissipated);
  const auto before = run.points(0, SurfaceKind::skin, 2), after = run.points(0, SurfaceKind::skin, 4);
  EXPECT_LT((run.velocities(0, SurfaceKind::skin, 3)[1] - 12 * (after[1] - before[1])).norm(), 1e-5);
  expect_error(ErrorKind::usage, "flag", [&] { run.find_body("sail"); });
  expect_error(ErrorKind::file, "no run here", [&] { RunReader(scratch.path()); });
}

TEST(RunDirectory, StoppedRunResumesToTheSameBytes) {
  Scratch scratch;
  run_to(scratch / "straight", 8, false);
  run_to(scratch / "stopped", 3, false);
  run_to(scratch / "stopped", 8, true);
  expect_same_run(scratch / "straight", scratch / "stopped");
}

TEST(RunDirectory, RunStoppedInsideAFrameResumesToTheSameBytes) {
  Scratch scratch;
  run_to(scratch / "straight", 4, false);
  {
    Simulation simulation(model());
    RunWriter writer(scratch / "stopped", simulation, 4, false);
    simulation.advance();
    writer.write_frame();
    int polls = 0;
    Progress progress;
    progress.cancelled = [&] { return ++polls > 2; };
    EXPECT_THROW(simulation.advance(progress), Error);
    writer.finish(RunStatus::interrupted, "test");
  }
  EXPECT_TRUE(fs::exists(scratch / "stopped/checkpoint/000001+0002.state"));
  EXPECT_EQ(RunReader(scratch / "stopped").status(), RunStatus::interrupted);
  run_to(scratch / "stopped", 4, true);
  expect_same_run(scratch / "straight", scratch / "stopped");
}

/// Runs body in a process of its own and returns how it ended, as waitpid says.
template <class Body>
pid_t fork_off(const Body& body) {
  const pid_t child = ::fork();
  if (child == 0) {
    int code = 99;
    try {
      body();
      code = 0;
    } catch (const Error& error) {
      code = static_cast<int>(error.kind());
    }
    ::_exit(code);
  }
  return child;
}

TEST(RunDirectory, KilledRunResumesToTheSameBytes) {
  Scratch scratch;
  constexpr int frames = 200;
  run_to(scratch / "straight", frames, false);
  int interrupted = 0;
  for (int delay_ms : {3, 11, 23, 42, 61, 95}) {
    const fs::path directory = scratch / ("killed" + std::to_string(delay_ms));
    // Killed twice, the second time while resuming.
    for (bool resume : {false, true}) {
      const pid_t child = fork_off([&] { run_to(directory, frames, resume); });
      std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
      ::kill(child, SIGKILL);
      int status = 0;
      ::waitpid(child, &status, 0);
      if (WIFSIGNALED(status)) ++interrupted;
    }
    run_to(directory, frames, true);
    expect_same_run(scratch / "straight", directory);
  }
  EXPECT_GT(interrupted, 3);
}

TEST(RunDirectory, IncompleteFramesAfterTheCheckpointAreTruncated) {
  Scratch scratch;
  run_to(scratch / "straight", 6, false);
  run_to(scratch / "run", 3, false, false);
  // A kill in the middle of frame 4 leaves points of one cache, half a sample of another, half a row.
  std::string skin = bytes_of(scratch / "run/flag.skin.pc2");
  skin += std::string(skin.end() - 8 * 12, skin.end());
  skin[28] = 5;  // the number of samples
  test::write_bytes(scratch / "run/flag.skin.pc2", skin);
  test::write_bytes(scratch / "run/flag.contour.pc2", bytes_of(scratch / "run/flag.contour.pc2") + "half");
  test::write_bytes(scratch / "run/diagnostics.csv", bytes_of(scratch / "run/diagnostics.csv") + "4,0.16,1");
  test::write_bytes(scratch / "run/checkpoint/000004.state.part", "half a checkpoint");
  test::write_bytes(scratch / "run/scene.toml.part", "half a scene");
  EXPECT_EQ(RunReader(scratch / "run").frame_count(), 4);
  run_to(scratch / "run", 6, true);
  expect_same_run(scratch / "straight", scratch / "run");
}

TEST(RunDirectory, DamagedCheckpointFallsBackToThePreviousOne) {
  Scratch scratch;
  run_to(scratch / "straight", 6, false);
  run_to(scratch / "run", 4, false);
  test::write_bytes(scratch / "run/checkpoint/000004.state",
                    bytes_of(scratch / "run/checkpoint/000004.state").substr(0, 500));
  run_to(scratch / "run", 6, true);
  expect_same_run(scratch / "straight", scratch / "run");
}

TEST(RunDirectory, MissingCacheIsNamed) {
  Scratch scratch;
  run_to(scratch / "run", 2, false);
  fs::remove(scratch / "run/flag.skin.pc2");
  expect_error(ErrorKind::file, "flag.skin.pc2: cannot open the point cache",
               [&] { run_to(scratch / "run", 3, true); });
}

TEST(RunDirectory, FullDiskIsAnErrorAndTheRunIsResumable) {
  Scratch scratch;
  constexpr int frames = 40;
  run_to(scratch / "straight", frames, false);
  const pid_t child = fork_off([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{6500, 6500};  // bytes a file may have
    ::setrlimit(RLIMIT_FSIZE, &limit);
    run_to(scratch / "run", frames, false);
  });
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), static_cast<int>(ErrorKind::file));
  const RunReader broken(scratch / "run");
  EXPECT_GT(broken.frame_count(), 2);
  EXPECT_LT(broken.frame_count(), frames);
  run_to(scratch / "run", frames, true);
  expect_same_run(scratch / "straight", scratch / "run");
}

TEST(RunDirectory, ReplacesOnlyAnEarlierRun) {
  Scratch scratch;
  run_to(scratch / "run", 5, false);
  test::write_bytes(scratch / "run/notes.txt", "mine");
  run_to(scratch / "run", 2, false);
  EXPECT_EQ(bytes_of(scratch / "run/notes.txt"), "mine");
  EXPECT_EQ(RunReader(scratch / "run").frame_count(), 3);
  EXPECT_FALSE(fs::exists(scratch / "run/checkpoint/000005.state"));
}

TEST(RunDirectory, RefusesDirectoriesWithoutARun) {
  Scratch scratch;
  test::write_bytes(scratch / "file", "x");
  fs::create_directories(scratch / "photos");
  test::write_bytes(scratch / "photos/cat.png", "x");
  expect_error(ErrorKind::file, "not a directory", [&] { run_to(scratch / "file", 1, false); });
  expect_error(ErrorKind::file, "holds no run", [&] { run_to(scratch / "photos", 1, false); });
  expect_error(ErrorKind::file, "holds no run", [&] { run_to(scratch / "photos", 1, true); });
  expect_error(ErrorKind::file, "file/below", [&] { run_to(scratch / "file/below", 1, false); });
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch / "photos"), {}), 1);
}

TEST(RunDirectory, AllowsOneWritingProcess) {
  Scratch scratch;
  Simulation simulation(model());
  RunWriter writer(scratch / "run", simulation, 1, false);
  expect_error(ErrorKind::file, "another process", [&] { run_to(scratch / "run", 1, true); });
}

TEST(RunDirectory, NamesChangesOfBodies) {
  Scratch scratch;
  run_to(scratch / "run", 2, false);
  Model changed = small_model();
  changed.scene.resolved = R"({"title":"a small flag","body":[{"name":"flag","voxel_width":0.5}]})";
  Simulation simulation(std::make_shared<const Model>(std::move(changed)));
  expect_error(ErrorKind::input, "body.0.voxel_width",
               [&] { RunWriter(scratch / "run", simulation, 4, true); });
}

TEST(RunDirectory, RecordsOtherChangesOnResume) {
  Scratch scratch;
  run_to(scratch / "run", 2, false);
  Model changed = small_model();
  changed.scene.resolved = R"({"title":"the flag","body":[{"name":"flag","voxel_width":1.0}]})";
  Simulation simulation(std::make_shared<const Model>(std::move(changed)));
  RunWriter writer(scratch / "run", simulation, 4, true);
  EXPECT_TRUE(writer.resumed());
  EXPECT_EQ(simulation.frame(), 2);
  EXPECT_EQ(writer.changes(), std::vector<std::string>{"title"});
  writer.finish(RunStatus::interrupted);
  const auto run = nlohmann::json::parse(bytes_of(scratch / "run/run.json"));
  EXPECT_EQ(run["timings"]["sessions"][1]["changed"][0], "title");
}

TEST(RunDirectory, NamesThatCannotBeFileNamesAreRefused) {
  for (const char* name : {"", "../flag", "a/b", ".hidden", "two\nlines"})
    expect_error(ErrorKind::input, "cannot name files", [&] { skin_files(name); });
  EXPECT_EQ(skin_files("Fahne 2").cache, "Fahne 2.skin.pc2");
}

}  // namespace
}  // namespace muslin
