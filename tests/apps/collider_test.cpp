// Colliders and rigid bodies through the program: runs, resumes, thread counts, exports, pictures, and what
// `check` says of a tangled start.
#include <set>

#include "apps/program.hpp"
#include "support/sheet.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "muslin/cache/run_reader.hpp"
#include "muslin/io/mesh_file.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::run;
using test::Scratch;
using testing::HasSubstr;

/// A cloth of 0.4 m falls on a ball and a box that moves, a heavy ball falls on it, all above a floor.
void write_scene(const Scratch& scratch, const std::string& more = "") {
  write_mesh(scratch / "sheet.obj", test::flat_sheet(12, 12, 0.4, 0.4));
  test::write_bytes(
      scratch / "scene.toml",
      "[[body]]\nname = \"cloth\"\nmesh = \"sheet.obj\"\nmodel = \"shell\"\n"
      "material = { areal_density = 0.2, membrane_warp = 500, bending_warp = 1e-4 }\n"
      "translate = [-0.2, 0, -0.2]\n" +
          more +
          "[[collider]]\nname = \"floor\"\nshape = \"plane\"\ncenter = [0, -0.3, 0]\n"
          "[[collider]]\nname = \"post\"\nshape = \"sphere\"\ncenter = [0, -0.11, 0]\nradius = 0.1\n"
          "[[collider]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0.05, 0.06, 0]\n"
          "radius = 0.03\ndensity = 700\ncolour = [0.9, 0.8, 0.1]\n"
          "[[collider]]\nname = \"lift\"\nshape = \"box\"\ncenter = [0.15, -0.2, 0]\n"
          "size = [0.05, 0.05, 0.05]\nkeyframes = [{ time = 0 }, { time = 0.5, translate = [0, 0.1, 0] }]\n"
          "[[force]]\ntype = \"gravity\"\n"
          "[[probe]]\nname = \"middle of the ball\"\nbody = \"ball\"\nat = [0.05, 0.06, 0]\n");
}

std::vector<std::string> words(const Scratch& scratch, const std::string& directory, int frames) {
  return {"run",      (scratch / "scene.toml").string(),
          "-o",       (scratch / directory).string(),
          "--frames", std::to_string(frames),
          "--quiet"};
}

TEST(ColliderRun, ShowsCollidersAndResumesBitForBit) {
  const Scratch scratch;
  write_scene(scratch);
  const auto straight = run(scratch, words(scratch, "straight", 6));
  ASSERT_EQ(straight.code, 0) << straight.err;
  ASSERT_EQ(run(scratch, words(scratch, "stopped", 3)).code, 0);
  std::vector<std::string> resume = words(scratch, "stopped", 6);
  resume.emplace_back("--resume");
  ASSERT_EQ(run(scratch, resume).code, 0);
  std::vector<std::string> threads = words(scratch, "threads", 6);
  threads.insert(threads.end(), {"--threads", "1"});
  ASSERT_EQ(run(scratch, threads).code, 0);
  for (const char* file : {"cloth.skin.pc2", "ball.skin.pc2", "lift.skin.pc2", "probes.csv", "stats.json"}) {
    EXPECT_TRUE(bytes_of(scratch / "straight" / file) == bytes_of(scratch / "stopped" / file)) << file;
    EXPECT_TRUE(bytes_of(scratch / "straight" / file) == bytes_of(scratch / "threads" / file)) << file;
  }
  const auto stats = nlohmann::json::parse(bytes_of(scratch / "straight" / "stats.json"));
  EXPECT_EQ(stats["bodies"].size(), 1u);
  EXPECT_EQ(stats["colliders"].size(), 4u);

  const RunReader reader(scratch / "straight");
  ASSERT_EQ(reader.bodies().size(), 5u);
  const int floor = reader.find_body("floor"), ball = reader.find_body("ball"),
            lift = reader.find_body("lift");
  EXPECT_TRUE(reader.is_plane(floor) && reader.is_collider(ball) && !reader.is_collider(0));
  EXPECT_EQ(reader.colour(ball), Vec3(0.9, 0.8, 0.1));
  EXPECT_EQ(reader.colour(lift), Vec3(0.52, 0.54, 0.57));
  EXPECT_EQ(reader.points(floor, SurfaceKind::skin, 6), reader.points(floor, SurfaceKind::skin, 0));
  const float up =
      reader.points(lift, SurfaceKind::skin, 6)[0].y() - reader.points(lift, SurfaceKind::skin, 0)[0].y();
  EXPECT_NEAR(up, 0.05, 1e-6);
  EXPECT_LT(reader.points(ball, SurfaceKind::skin, 6)[0].y(),
            reader.points(ball, SurfaceKind::skin, 0)[0].y() - 0.01);
  for (const Diagnostics& row : reader.diagnostics()) EXPECT_GT(row.min_distance, 0) << row.frame;

  ASSERT_EQ(run(scratch, {"render", (scratch / "straight").string(), "-o", (scratch / "a.png").string(),
                          "--size", "160x90", "--samples", "1", "--quiet"})
                .code,
            0);
  for (const char* file : {"a.obj", "a.usda", "a.glb", "a.vtu"}) {
    const auto outcome = run(
        scratch, {"export", (scratch / "straight").string(), (scratch / file).string(), "--body", "ball"});
    EXPECT_EQ(outcome.code, 0) << file << ": " << outcome.err;
  }
  ASSERT_EQ(
      run(scratch, {"build", (scratch / "scene.toml").string(), "-o", (scratch / "stages").string()}).code,
      0);
  EXPECT_TRUE(fs::exists(scratch / "stages" / "post.skin.obj"));
}

TEST(ColliderRun, RefusesToResumeWithAnotherCollider) {
  const Scratch scratch;
  write_scene(scratch);
  ASSERT_EQ(run(scratch, words(scratch, "run", 1)).code, 0);
  std::vector<std::string> resume = words(scratch, "run", 2);
  resume.insert(resume.end(), {"--resume", "--set", "collider.post.radius=0.09"});
  const auto outcome = run(scratch, resume);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("collider.1.radius"));
  // So it is where the other collider would cross the cloth at the start.
  resume.back() = "collider.post.radius=0.2";
  const auto crossing = run(scratch, resume);
  EXPECT_EQ(crossing.code, 3);
  EXPECT_THAT(crossing.err, HasSubstr("changed: collider.1.radius"));
}

/// A patch of cloth lies on a slope of tan = 0.3, drawn level: gravity is tilted instead.
void write_slope(const Scratch& scratch) {
  write_mesh(scratch / "patch.obj", test::flat_sheet(3, 3, 0.1, 0.1));
  test::write_bytes(scratch / "scene.toml",
                    "[time]\nsteps_per_frame = 4\n"
                    "[[body]]\nname = \"cloth\"\nmesh = \"patch.obj\"\nmodel = \"shell\"\n"
                    "material = \"wool\"\ntranslate = [0, 0.0025, 0]\nfriction = 0.5\n"
                    "[[collider]]\nname = \"slope\"\nshape = \"plane\"\n"
                    "[contact]\ndistance = 0.001\nfriction = 0.5\n"
                    "[[force]]\ntype = \"gravity\"\nacceleration = [2.82, -9.4, 0]\n"
                    "[[probe]]\nname = \"middle\"\nbody = \"cloth\"\nat = [0.05, 0.0025, 0.05]\n");
}

/// Mean velocity of the patch downhill [m/s].
double downhill(const Scratch& scratch, int frame) {
  const RunReader reader(scratch / "run");
  double sum = 0;
  const auto velocities = reader.velocities(reader.find_body("cloth"), SurfaceKind::skin, frame);
  for (const Vec3f& v : velocities) sum += v.x();
  return sum / static_cast<double>(velocities.size());
}

TEST(ColliderRun, ResumesWithChangedFrictionOfBodyAndCollider) {
  const Scratch scratch;
  write_slope(scratch);
  const auto go_on = [&](int frames, const std::vector<std::string>& settings) {
    std::vector<std::string> arguments = words(scratch, "run", frames);
    arguments.emplace_back("--resume");
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    return run(scratch, arguments);
  };
  const auto points = [&] { return bytes_of(scratch / "run" / "cloth.skin.pc2"); };
  // Mean acceleration between the middles of two frames [m/s2].
  const auto acceleration = [&](int first, int last) {
    return (downhill(scratch, last) - downhill(scratch, first)) * 24 / (last - first);
  };

  ASSERT_EQ(go_on(12, {}).code, 0);
  EXPECT_NEAR(downhill(scratch, 11), 0, 1e-4) << "0.5 holds";
  const std::string held = points();

  // The body's friction: with the collider's 0.5 it is 0.1 between them.
  auto outcome = go_on(24, {"body.cloth.friction=0.02"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("resumed with body.0.friction\n"));
  EXPECT_NEAR(acceleration(14, 22), 2.82 - 0.1 * 9.4, 0.02);
  // Written samples stay; only the count of samples in the header of the cache grows.
  EXPECT_EQ(points().substr(32, held.size() - 32), held.substr(32));

  // The collider's friction, which was the default; the body's is that of the file again. It is 0.2 between
  // them.
  outcome = go_on(36, {"collider.slope.friction=0.08"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("resumed with body.0.friction\n"),
                                          HasSubstr("resumed with collider.0.friction\n")));
  EXPECT_NEAR(acceleration(26, 34), 2.82 - 0.2 * 9.4, 0.02);

  // As it was at first: it brakes, and holds again.
  ASSERT_EQ(go_on(66, {}).code, 0);
  EXPECT_NEAR(acceleration(38, 44), 2.82 - 0.5 * 9.4, 0.02);
  EXPECT_NEAR(downhill(scratch, 65), 0, 1e-4);
  const auto sessions = nlohmann::json::parse(bytes_of(scratch / "run" / "run.json"))["timings"]["sessions"];
  ASSERT_EQ(sessions.size(), 4u);
  EXPECT_EQ(sessions[1]["changed"], (nlohmann::json{"body.0.friction"}));
  EXPECT_EQ(sessions[3]["changed"], (nlohmann::json{"collider.0.friction"}));

  // An invalid friction is refused before anything is written.
  outcome = go_on(70, {"body.cloth.friction=-0.1"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("friction"));
  EXPECT_EQ(RunReader(scratch / "run").frame_count(), 67);
}

TEST(ColliderRun, CheckListsCrossingsOfTheStart) {
  const Scratch scratch;
  write_scene(scratch);
  const std::string scene = (scratch / "scene.toml").string();
  EXPECT_EQ(run(scratch, {"check", scene}).code, 0);

  const std::string high = "collider.post.center=[0, -0.05, 0]";
  const std::string picture = (scratch / "start.png").string();
  const auto text = run(scratch, {"check", scene, "--set", high, "--picture", picture});
  EXPECT_EQ(text.code, 0);
  EXPECT_THAT(text.err, testing::ContainsRegex("surfaces cross at the start in ([0-9]+) places: [0-9]+ of "
                                               "\"cloth\" and \"post\""));
  EXPECT_THAT(text.err, HasSubstr("the run pulls them apart before its first frame"));
  EXPECT_THAT(text.out, testing::AllOf(HasSubstr("where surfaces cross"), HasSubstr("\"cloth\""),
                                       HasSubstr("\"post\"")));
  EXPECT_EQ(bytes_of(picture).substr(1, 3), "PNG");
  const auto json = run(scratch, {"check", scene, "--json", "--set", high});
  EXPECT_EQ(json.code, 0);
  const auto crossings = nlohmann::json::parse(json.out)["crossings"];
  ASSERT_GT(crossings.size(), 0u);
  EXPECT_EQ(crossings[0]["bodies"], (nlohmann::json{"cloth", "post"}));
  EXPECT_LT(std::abs(crossings[0]["at"][1].get<double>()), 0.06);
  std::set<std::string> pairs;
  for (const auto& crossing : crossings)
    EXPECT_TRUE(pairs.insert(crossing["bodies"].dump() + crossing["faces"].dump()).second) << crossing.dump();
  std::vector<std::string> start = words(scratch, "run", 1);
  start.insert(start.end(), {"--set", high});
  const auto json_of_run = [&] { return nlohmann::json::parse(bytes_of(scratch / "run" / "run.json")); };
  const auto repaired = run(scratch, start);
  EXPECT_EQ(repaired.code, 0);
  EXPECT_THAT(repaired.err, HasSubstr("muslin: warning: the start was tangled: "));
  EXPECT_GT(json_of_run()["tangled_start"]["too_close"].get<int>() +
                json_of_run()["tangled_start"]["crossings"].get<int>(),
            0);
  EXPECT_EQ(json_of_run()["tangled_start"]["left"], 0);
  EXPECT_GT(RunReader(scratch / "run").diagnostics().front().min_distance, 0);

  const std::string refuse = "contact.tangled=refuse";
  EXPECT_EQ(run(scratch, {"check", scene, "--set", high, "--set", refuse}).code, 3);
  std::vector<std::string> strict = start;
  strict.insert(strict.end(), {"--set", refuse});
  const auto refused = run(scratch, strict);
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("muslin: " + scene + ": surfaces cross at the start: face "));
  start.emplace_back("--allow-tangled");
  EXPECT_EQ(run(scratch, start).code, 0);

  // Crossings are reported, and a resumed run keeps the permission.
  EXPECT_EQ(json_of_run()["allow_tangled"], true);
  const RunReader tangled(scratch / "run");
  EXPECT_LT(tangled.diagnostics().front().min_distance, 0);
  std::vector<std::string> resume = words(scratch, "run", 2);
  resume.insert(resume.end(), {"--set", high, "--resume"});
  EXPECT_EQ(run(scratch, resume).code, 0);
  EXPECT_EQ(json_of_run()["allow_tangled"], true);
  EXPECT_EQ(RunReader(scratch / "run").diagnostics().size(), 3u);
}

TEST(ColliderRun, ReportsHeldBackVertices) {
  const Scratch scratch;
  write_scene(scratch);
  // A floor that rises into a plane above: the cloth between them stops it, until it sinks again.
  test::write_bytes(
      scratch / "press.toml",
      "[time]\nduration = 0.5\n[[body]]\nname = \"cloth\"\nmesh = \"sheet.obj\"\nmodel = \"shell\"\n"
      "material = { areal_density = 0.2, membrane_warp = 500, bending_warp = 1e-4 }\n"
      "[[collider]]\nname = \"floor\"\nshape = \"plane\"\ncenter = [0, -0.01, 0]\n"
      "[[collider]]\nname = \"lid\"\nshape = \"box\"\nsize = [1, 0.1, 1]\ncenter = [0, 0.06, 0]\n"
      "keyframes = [{ time = 0 }, { time = 0.1, translate = [0, -0.05, 0] }, { time = 0.3 }]\n");
  const std::string scene = (scratch / "press.toml").string(), out = (scratch / "run").string();
  const auto held_back = [&] {
    return nlohmann::json::parse(bytes_of(scratch / "run" / "run.json"))["held_back"];
  };
  const auto pressed = run(scratch, {"run", scene, "-o", out, "--frames", "4", "--quiet"});
  EXPECT_EQ(pressed.code, 0) << pressed.err;
  EXPECT_THAT(pressed.err,
              testing::ContainsRegex("muslin: warning: pins or colliders that move could not follow "
                                     "their keyframes in frames? [0-9to and,]+: .*they "
                                     "still are behind"));
  const auto then = held_back();
  EXPECT_GT(then["most"], 0);
  EXPECT_EQ(then["frames"].back(), 4);
  // At the end of frame 3, 0.125 s, its path leads 43.75 mm down, of which 20 mm are free.
  EXPECT_NEAR(then["farthest"], 0.02375, 0.001);
  const auto freed = run(scratch, {"run", scene, "-o", out, "--quiet", "--resume"});
  EXPECT_EQ(freed.code, 0) << freed.err;
  EXPECT_THAT(freed.err, HasSubstr("they have caught up"));
  const auto free = run(scratch, {"run", scene, "-o", (scratch / "free").string(), "--quiet", "--set",
                                  "collider.lid.keyframes=[{time=0}]"});
  EXPECT_EQ(free.code, 0) << free.err;
  EXPECT_THAT(free.err, testing::Not(HasSubstr("could not follow")));
}

}  // namespace
}  // namespace muslin
