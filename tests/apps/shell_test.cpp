// A shell from outside: run, stopped and resumed, drawn from all exports.
#include "apps/program.hpp"
#include "support/sheet.hpp"
#include <gmock/gmock.h>
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

/// A sheet held at two corners beside a lattice, so that indices of both bodies are in play.
void write_shell_scene(const Scratch& scratch) {
  write_mesh(scratch / "sheet.obj", test::flat_sheet(8, 6, 0.4, 0.3));
  test::write_bytes(
      scratch / "scene.toml",
      "[time]\nduration = 0.5\n[[body]]\nname = \"block\"\nmesh = \"sheet.obj\"\n"
      "voxel_width = 0.1\nmaterial = \"rubber\"\ntranslate = [1, 0, 0]\n"
      "[[body]]\nname = \"cloth\"\nmesh = \"sheet.obj\"\nmodel = \"shell\"\nmaterial = \"cotton\"\n"
      "[[pin]]\nbody = \"cloth\"\nwhere = { nearest = [[0, 0, 0], [0.4, 0, 0]] }\n"
      "[[force]]\ntype = \"gravity\"\n[[force]]\ntype = \"wind\"\nvelocity = [0, 0, 1]\n"
      "[[probe]]\nname = \"hem\"\nbody = \"cloth\"\nat = [0.21, 0, 0.3]\n");
}

std::vector<std::string> words(const Scratch& scratch, const std::string& directory, int frames) {
  return {"run",      (scratch / "scene.toml").string(),
          "-o",       (scratch / directory).string(),
          "--frames", std::to_string(frames),
          "--quiet"};
}

TEST(ShellRun, ResumedIsTheSameRun) {
  const Scratch scratch;
  write_shell_scene(scratch);
  ASSERT_EQ(run(scratch, words(scratch, "straight", 6)).code, 0);
  ASSERT_EQ(run(scratch, words(scratch, "stopped", 3)).code, 0);
  std::vector<std::string> resume = words(scratch, "stopped", 6);
  resume.emplace_back("--resume");
  ASSERT_EQ(run(scratch, resume).code, 0);
  for (const char* file : {"cloth.skin.pc2", "block.skin.pc2", "probes.csv", "stats.json"})
    EXPECT_TRUE(bytes_of(scratch / "straight" / file) == bytes_of(scratch / "stopped" / file)) << file;
  EXPECT_FALSE(fs::exists(scratch / "straight" / "cloth.contour.obj"));
  // Another fold is another cloth.
  resume.insert(resume.end(), {"--set", "body.cloth.warp=[0, 0, 1]"});
  EXPECT_THAT(run(scratch, resume).err, HasSubstr("body.1.warp"));
}

TEST(ShellRun, HasTheSameBitsOnOneAndTwoThreads) {
  const Scratch scratch;
  write_shell_scene(scratch);
  for (const char* threads : {"1", "2"}) {
    std::vector<std::string> arguments = words(scratch, threads, 4);
    arguments.insert(arguments.end(), {"--threads", threads});
    ASSERT_EQ(run(scratch, arguments).code, 0);
  }
  EXPECT_TRUE(bytes_of(scratch / "1" / "cloth.skin.pc2") == bytes_of(scratch / "2" / "cloth.skin.pc2"));
}

TEST(ShellRun, IsExportedAndBuilt) {
  const Scratch scratch;
  write_shell_scene(scratch);
  ASSERT_EQ(run(scratch, words(scratch, "run", 2)).code, 0);
  const std::string directory = (scratch / "run").string();
  for (const char* file : {"a.pc2", "a.mdd", "a.obj", "a.ply", "a.glb", "a.usda", "a.vtu"}) {
    const auto outcome = run(scratch, {"export", directory, (scratch / file).string(), "--body", "cloth"});
    EXPECT_EQ(outcome.code, 0) << file << ": " << outcome.err;
  }
  EXPECT_THAT(bytes_of(scratch / "a.0002.vtu"), testing::AllOf(HasSubstr("stretch"), HasSubstr("velocity")));
  const auto contour = run(scratch, {"export", directory, (scratch / "b.obj").string(), "--body", "cloth",
                                     "--surface", "contour"});
  EXPECT_EQ(contour.code, 2);
  EXPECT_THAT(contour.err, HasSubstr("has no contour"));
  ASSERT_EQ(
      run(scratch, {"build", (scratch / "scene.toml").string(), "-o", (scratch / "stages").string()}).code,
      0);
  EXPECT_THAT(bytes_of(scratch / "stages" / "cloth.shell.vtu"), HasSubstr("warp"));
  const auto stats = nlohmann::json::parse(bytes_of(scratch / "stages" / "stats.json"));
  EXPECT_EQ(stats["bodies"][1]["triangles"], 96);

  const RunReader reader(scratch / "run");
  EXPECT_TRUE(reader.has_cells(0));
  EXPECT_FALSE(reader.has_cells(1));
  const auto points = reader.points(1, SurfaceKind::skin, 2);
  EXPECT_EQ(points[0], Vec3f::Zero());
  EXPECT_LT(points[62].y(), -0.001F);
}

TEST(ShellRun, UnweldedMeshesAreReported) {
  const Scratch scratch;
  test::write_bytes(scratch / "torn.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3\nf 4 5 6\n");
  test::write_bytes(scratch / "flap.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0.2 -1 0.2\nv 0.2 1 0.2\nv 0.3 1 0.3\nf 1 2 3\nf 4 5 6\n");
  for (const auto& [mesh, advice] : {std::pair("torn.obj", "merge vertices of a mesh that lie at one place"),
                                     std::pair("flap.obj", "self_contact = false")}) {
    test::write_bytes(scratch / "scene.toml",
                      std::string("[contact]\ntangled = \"refuse\"\n[[body]]\nmesh = \"") + mesh +
                          "\"\nmodel = \"shell\"\nmaterial = \"cotton\"\n");
    for (const auto& command : {words(scratch, "run", 1), {"check", (scratch / "scene.toml").string()}}) {
      const auto outcome = run(scratch, command);
      EXPECT_EQ(outcome.code, 3) << command[0];
      EXPECT_THAT(outcome.err, HasSubstr(advice)) << command[0];
    }
  }
}

}  // namespace
}  // namespace muslin
