// Exit codes and messages: what a script or a person sees of every mistake.
#include <regex>

#include "apps/program.hpp"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace muslin {
namespace {

using test::Outcome;
using test::Process;
using test::run;
using test::Scratch;
using test::two_corners;
using testing::HasSubstr;
using testing::IsEmpty;

/// One line `muslin: what; what to do` on standard error, nothing on standard output.
void expect_refusal(const Outcome& outcome, int code, const std::string& part) {
  EXPECT_EQ(outcome.code, code) << outcome.err;
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, HasSubstr(part));
  EXPECT_TRUE(std::regex_match(outcome.err, std::regex("muslin: [^\n]+; [^\n]+\n"))) << outcome.err;
}

TEST(CommandLine, HelpAndVersionSucceed) {
  Scratch scratch;
  for (const char* word : {"--help", "--version"}) EXPECT_EQ(run(scratch, {word}).code, 0);
  for (const char* command :
       {"run", "check", "build", "field", "render", "export", "report", "materials", "schema"}) {
    const Outcome help = run(scratch, {command, "--help"});
    EXPECT_EQ(help.code, 0) << command;
    EXPECT_THAT(run(scratch, {"--help"}).out, HasSubstr(command));
    EXPECT_THAT(help.out, HasSubstr("--help")) << command;
  }
}

TEST(CommandLine, UsageErrorsExitWith2AndAdvice) {
  Scratch scratch;
  const auto usage = [&](const std::vector<std::string>& words, const std::string& part) {
    SCOPED_TRACE(testing::PrintToString(words));
    expect_refusal(run(scratch, words), 2, part);
  };
  usage({}, "--help");
  usage({"rnu", two_corners}, "`run`");
  usage({"frobnicate"}, "one of `run`");
  usage({"run"}, "SCENE");
  usage({"run", two_corners, "--frame", "3"}, "`--frames`");
  usage({"run", two_corners, "--frames", "-3"}, "whole number");
  usage({"run", two_corners, "--frames", "99999999999"}, "whole number");
  usage({"run", two_corners, "--threads", "two"}, "whole number");
  usage({"run", two_corners, "--set", "time.duration"}, "KEY=VALUE");
  usage({"run", two_corners, "--set", "..=1"}, "KEY=VALUE");
  usage({"check", two_corners, "extra"}, "extra");
  usage({"field", "x.obj"}, "--voxel-width");
  usage({"field", "x.obj", "--voxel-width", "nan"}, "above 0");
  usage({"field", "x.obj", "--voxel-width", "1", "--slice", "w=1"}, "slice");
  expect_refusal(run(scratch, {"materials", "coton"}), 3, "`cotton`");
}

TEST(CommandLine, InputErrorsExitWith3AndThePlace) {
  Scratch scratch;
  const std::string scene = scratch / "scene.toml";
  const std::string mesh = (test::scenes / "meshes" / "flag.obj").string();
  const auto input = [&](const std::string& text, const std::string& part) {
    SCOPED_TRACE(text);
    test::write_bytes(scene, text);
    const Outcome outcome = run(scratch, {"check", scene});
    expect_refusal(outcome, 3, part);
    EXPECT_THAT(outcome.err, HasSubstr("muslin: " + scene + ":"));
    expect_refusal(run(scratch, {"run", scene, "-o", scratch / "run"}), 3, part);
    EXPECT_FALSE(std::filesystem::exists(scratch / "run"));
  };
  input("[[body]\n", ":1:");
  input("[time]\nduration = -1\n", ":2:");
  input("[tiem]\n", "`time`");
  input("[time]\nduraton = 1\n", "`duration`");
  input("title = \"nothing\"\n", "[[body]]");
  test::write_scene(scene, mesh, "voxel_width = 0\nmaterial = \"thesis_flag\"\n");
  input(test::bytes_of(scene), ":6:");
  test::write_scene(scene, mesh, "voxel_width = 1\nmaterial = \"thesis_flg\"\n");
  input(test::bytes_of(scene), "thesis_flag");
}

TEST(CommandLine, FileErrorsExitWith5) {
  Scratch scratch;
  ::mkfifo((scratch / "pipe.toml").c_str(), 0600);
  std::filesystem::create_directory(scratch / "folder.toml");
  std::filesystem::create_symlink("/dev/zero", scratch / "zero.toml");
  std::filesystem::create_symlink("/dev/zero", scratch / "zero.obj");
  std::filesystem::create_symlink("loop.toml", scratch / "loop.toml");
  for (const char* name :
       {"none.toml", "none.obj", "pipe.toml", "folder.toml", "zero.toml", "zero.obj", "loop.toml"}) {
    SCOPED_TRACE(name);
    expect_refusal(run(scratch, {"check", scratch / name}), 5, name);
  }
  {
    std::ofstream(scratch / "large.toml") << "#";
  }
  std::filesystem::resize_file(scratch / "large.toml", std::uintmax_t{2} << 30);  // sparse
  expect_refusal(run(scratch, {"check", scratch / "large.toml"}), 5, "larger than 64 MiB");
}

TEST(CommandLine, UnwritableStandardOutputExitsWith5) {
  Scratch scratch;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"check", two_corners}, {"materials"}, {"check", "--json", two_corners}}) {
    Process::Streams full;
    full.out = "/dev/full";
    const Outcome outcome = run(scratch, words, full);
    EXPECT_EQ(outcome.code, 5);
    EXPECT_THAT(outcome.err, HasSubstr("standard output"));
    Process::Streams closed;
    closed.before = [] { ::close(STDOUT_FILENO); };
    EXPECT_EQ(run(scratch, words, closed).code, 5);
  }
}

TEST(CommandLine, CheckPrintsTheCountsOfTheThesisFlag) {
  Scratch scratch;
  const Outcome json = run(scratch, {"check", "--json", two_corners});
  ASSERT_EQ(json.code, 0) << json.err;
  EXPECT_THAT(json.err, IsEmpty());
  const auto body = nlohmann::json::parse(json.out)["bodies"][0];
  EXPECT_EQ(body["name"], "flag");
  EXPECT_EQ(body["vertices"], 154);
  EXPECT_EQ(body["voxels"], 60);
  EXPECT_EQ(body["tetrahedra"], 360);
  EXPECT_EQ(body["springs"]["edge"], 349);
  EXPECT_EQ(body["springs"]["face_diagonal"], 256);
  EXPECT_EQ(body["springs"]["body_diagonal"], 60);
  EXPECT_NEAR(body["mass"].get<double>(), 600, 1e-9);
  const Outcome text = run(scratch, {"check", two_corners});
  EXPECT_THAT(text.out, HasSubstr("349 edge, 256 face diagonal, 60 body diagonal"));
  EXPECT_THAT(text.out, HasSubstr("600 kg"));
}

TEST(CommandLine, CheckReportsOnAMesh) {
  Scratch scratch;
  const std::string mesh = (test::scenes / "meshes" / "flag_box.obj").string();
  const Outcome json = run(scratch, {"check", "--json", mesh});
  ASSERT_EQ(json.code, 0) << json.err;
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report["faces"], 6);
  EXPECT_EQ(report["triangles"], 12);
  EXPECT_EQ(report["closed"], true);
  EXPECT_NEAR(report["volume"].get<double>(), 60, 1e-9);
  EXPECT_THAT(run(scratch, {"check", mesh}).out, HasSubstr("closed, volume 60"));
}

TEST(CommandLine, VerifyRunsOneTestOrAllWithAPrefix) {
  Scratch scratch;
  for (const char* name : {"free-fall", "free"}) {
    const Outcome outcome = run(scratch, {"verify", name});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("1 of 1 pass"));
  }
  const std::string csv = run(scratch, {"verify", "free-fall", "--csv"}).out;
  EXPECT_THAT(csv, HasSubstr("test,quantity,reference,measured,"));
  EXPECT_THAT(csv, HasSubstr("free-fall,\"drop after 100 steps [m]\",4.94"));
  expect_refusal(run(scratch, {"verify", "fre"}), 2, "there is no test `fre`");
}

TEST(CommandLine, OverridesReachTheSceneAndMistakesAreReported) {
  Scratch scratch;
  const Outcome good = run(scratch, {"check", "--json", two_corners, "--set", "time.duration=1", "--set",
                                     "body.flag.voxel_width=0.5", "--set", "body.0.thickness=1"});
  ASSERT_EQ(good.code, 0) << good.err;
  const auto json = nlohmann::json::parse(good.out);
  EXPECT_EQ(json["time"]["frames"], 24);
  EXPECT_EQ(json["bodies"][0]["voxels"], 20 * 12 * 2);
  for (const char* setting :
       {"time.duration=nan", "time.duration=inf", "force.0.acceleration=[nan,0,0]",
        "body.flag.velocity=[0,1e999,0]", "time.steps_per_frame=1000000000", "time.frame_rate=1e-9",
        "body.flag.scale=0", "nonsense.key=1", "body.banner.voxel_width=1", "body.flag.material.density=0",
        "solver.tolerance=0"}) {
    SCOPED_TRACE(setting);
    expect_refusal(run(scratch, {"check", two_corners, "--set", setting}), 3, "--set");
  }
}

}  // namespace
}  // namespace muslin
