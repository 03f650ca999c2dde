// Runs from outside: killed, interrupted, resumed, on full disks and with bad numbers.
#include <chrono>
#include <cmath>
#include <cstring>
#include <random>
#include <thread>

#include "apps/program.hpp"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace muslin {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Outcome;
using test::Process;
using test::run;
using test::Scratch;
using test::two_corners;
using testing::HasSubstr;

nlohmann::json summary(const fs::path& directory) {
  return nlohmann::json::parse(bytes_of(directory / "run.json"));
}

/// Every file of two runs is equal but for wall times.
void expect_same_run(const fs::path& a, const fs::path& b) {
  for (const auto& entry : fs::recursive_directory_iterator(a)) {
    const fs::path name = fs::relative(entry.path(), a);
    if (!entry.is_regular_file() || name == "run.json" || name.filename() == "lock") continue;
    ASSERT_TRUE(fs::exists(b / name)) << name;
    if (name == "diagnostics.csv") {
      EXPECT_EQ(test::without_wall_times(bytes_of(a / name)), test::without_wall_times(bytes_of(b / name)));
    } else {
      EXPECT_TRUE(bytes_of(a / name) == bytes_of(b / name)) << name;
    }
  }
}

/// No number of a PC2 file is infinite or not a number.
void expect_finite(const fs::path& cache) {
  const std::string bytes = bytes_of(cache);
  ASSERT_GT(bytes.size(), 32u) << cache;
  for (std::size_t at = 32; at + 4 <= bytes.size(); at += 4) {
    float x = 0;
    std::memcpy(&x, bytes.data() + at, 4);
    ASSERT_TRUE(std::isfinite(x)) << cache << " at " << at;
  }
}

std::vector<std::string> run_words(const fs::path& directory, int frames) {
  return {"run", two_corners, "-o", directory.string(), "--frames", std::to_string(frames), "--quiet"};
}

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(Program, WritesTheRequestedFramesAndReplacesAnEarlierRun) {
  Scratch scratch;
  ASSERT_EQ(run(scratch, run_words(scratch / "run", 6)).code, 0);
  EXPECT_EQ(summary(scratch / "run")["status"], "finished");
  const auto size = fs::file_size(scratch / "run/flag.lattice.pc2");
  EXPECT_EQ(size, 32u + 7 * 154 * 12);
  ASSERT_EQ(run(scratch, run_words(scratch / "run", 2)).code, 0);
  EXPECT_EQ(fs::file_size(scratch / "run/flag.lattice.pc2"), 32u + 3 * 154 * 12);
  ASSERT_EQ(run(scratch, run_words(scratch / "none", 0)).code, 0);
  EXPECT_EQ(fs::file_size(scratch / "none/flag.lattice.pc2"), 32u + 154 * 12);
}

TEST(Program, ForeignDirectoriesAreUnchanged) {
  Scratch scratch;
  fs::create_directory(scratch / "photos");
  test::write_bytes(scratch / "photos/cat.png", "meow");
  const Outcome outcome = run(scratch, run_words(scratch / "photos", 1));
  EXPECT_EQ(outcome.code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("holds no run"));
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch / "photos"), fs::directory_iterator()), 1);
  // A file of one's own inside a run stays as well.
  ASSERT_EQ(run(scratch, run_words(scratch / "run", 1)).code, 0);
  test::write_bytes(scratch / "run/notes.txt", "mine");
  ASSERT_EQ(run(scratch, run_words(scratch / "run", 1)).code, 0);
  EXPECT_EQ(bytes_of(scratch / "run/notes.txt"), "mine");
}

TEST(Program, RunKilledAtRandomMomentsResumesToTheSameBytes) {
  Scratch scratch;
  const int frames = 40;
  ASSERT_EQ(run(scratch, run_words(scratch / "straight", frames)).code, 0);
  std::mt19937 random(std::random_device{}());
  std::uniform_int_distribution<int> pause(0, 150);
  int kills = 0;
  for (int attempt = 0; attempt < 12; ++attempt) {
    Process process(scratch, with(run_words(scratch / "killed", frames), {"--resume"}));
    std::this_thread::sleep_for(std::chrono::milliseconds(pause(random)));
    if (process.running()) ++kills;
    process.send(SIGKILL);
    process.wait();
  }
  const Outcome last = run(scratch, with(run_words(scratch / "killed", frames), {"--resume"}));
  ASSERT_EQ(last.code, 0) << last.err << " after " << kills << " kills";
  expect_same_run(scratch / "straight", scratch / "killed");
  EXPECT_EQ(summary(scratch / "killed")["status"], "finished");
}

TEST(Program, CtrlCExitsWith130AndIsResumable) {
  Scratch scratch;  // a run long enough that the signal comes before its end
  ASSERT_EQ(run(scratch, run_words(scratch / "straight", 4000)).code, 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    const fs::path directory = scratch / ("stopped" + std::to_string(signal));
    Process process(scratch, run_words(directory, 4000));
    // Not one checkpoint is waited for: on a busy machine it comes and goes unseen.
    const auto has_frames = [&] {
      std::error_code none_yet;
      const auto size = fs::file_size(directory / "diagnostics.csv", none_yet);
      return !none_yet && size > 1000;
    };
    while (process.running() && !has_frames()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    process.send(signal);
    const Outcome stopped = process.wait();
    ASSERT_EQ(stopped.code, 130) << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("--resume"));
    EXPECT_EQ(summary(directory)["status"], "interrupted");
    ASSERT_EQ(run(scratch, with(run_words(directory, 4000), {"--resume"})).code, 0);
    expect_same_run(scratch / "straight", directory);
  }
}

TEST(Program, ThreadsDoNotChangeABit) {
  Scratch scratch;
  const std::string scene = (test::scenes / "nylon_flag.toml").string();
  for (const char* threads : {"1", "2", "3"}) {  // 3375 voxels: many blocks in every parallel loop
    const Outcome outcome =
        run(scratch, {"run", scene, "-o", scratch / threads, "--frames", "1", "--quiet", "--threads", threads,
                      "--set", "body.0.voxel_width=0.02", "--set", "time.steps_per_frame=2"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_same_run(scratch / "1", scratch / threads);
  }
}

TEST(Program, FullDiskExitsWith5AndTheRunIsResumable) {
  Scratch scratch;
  ASSERT_EQ(run(scratch, run_words(scratch / "straight", 40)).code, 0);
  Process::Streams limited;
  limited.before = [] {  // as a full disk, for any user: no file may grow beyond this
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{150'000, 150'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  };
  const Outcome full = run(scratch, run_words(scratch / "run", 40), limited);
  EXPECT_EQ(full.code, 5) << full.err;
  EXPECT_THAT(full.err, HasSubstr("--resume"));
  EXPECT_THAT(full.err, HasSubstr("flag."));
  EXPECT_EQ(summary(scratch / "run")["status"], "failed");
  const Outcome exported = run(scratch, {"export", scratch / "run", scratch / "some.pc2", "--quiet"});
  EXPECT_EQ(exported.code, 0) << exported.err;
  ASSERT_EQ(run(scratch, with(run_words(scratch / "run", 40), {"--resume"})).code, 0);
  expect_same_run(scratch / "straight", scratch / "run");
}

TEST(Program, UnwritableDirectoryExitsWith5) {
  Scratch scratch;
  for (const std::string& directory :
       {std::string("/proc/muslin"), two_corners, two_corners + "/below", std::string("/dev/null/x"),
        (scratch / std::string(300, 'x')).string()}) {
    const Outcome outcome = run(scratch, run_words(directory, 1));
    EXPECT_EQ(outcome.code, 5) << directory;
    EXPECT_THAT(outcome.err, testing::StartsWith("muslin: "));
  }
}

TEST(Program, SolverFailureExitsWith4WithTheFrameAndASavedState) {
  Scratch scratch;
  const Outcome outcome = run(scratch, with(run_words(scratch / "run", 48),
                                            {"--set", "solver.integrator=symplectic_euler", "--set",
                                             "time.steps_per_frame=1", "--set", "time.frame_rate=0.01"}));
  ASSERT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("frame"));
  const auto json = summary(scratch / "run");
  EXPECT_EQ(json["status"], "failed");
  EXPECT_NE(json["reason"], "");
  EXPECT_FALSE(fs::is_empty(scratch / "run/checkpoint"));
  for (const char* cache : {"flag.skin.pc2", "flag.contour.pc2", "flag.lattice.pc2"})
    expect_finite(scratch / "run" / cache);
  EXPECT_THAT(bytes_of(scratch / "run/diagnostics.csv"), testing::Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace muslin
