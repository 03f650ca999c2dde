// muslin fit: files, exit codes, what is printed.
#include "apps/program.hpp"
#include <gmock/gmock.h>

namespace muslin {
namespace {

using test::bytes_of;
using test::Outcome;
using test::run;
using test::Scratch;
using test::write_bytes;
using testing::HasSubstr;

const std::string sheet = R"(name = "cloth"
areal_density = [0.118, 0.120]
[[bending]]
direction = "warp"
bending_length = [0.020, 0.021]
)";

TEST(FitCommand, WritesAMaterialThatSceneAndProgramRead) {
  Scratch scratch;
  write_bytes(scratch / "m.toml", sheet);
  const std::string file = (scratch / "cloth.toml").string();
  const Outcome outcome = run(scratch, {"fit", (scratch / "m.toml").string(), "-o", file});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("areal_density               0.119 kg/m2       0.001         -  measured\n"));
  EXPECT_THAT(outcome.out, HasSubstr("cantilever\n"));
  EXPECT_THAT(outcome.out, HasSubstr("guess: as the other thread\n"));
  EXPECT_THAT(outcome.out, HasSubstr(file));
  write_bytes(scratch / "quad.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 4 3 2\n");
  write_bytes(scratch / "scene.toml",
              "[[body]]\nname = \"b\"\nmesh = \"quad.obj\"\nmodel = \"shell\"\nmaterial = \"cloth.toml\"\n");
  EXPECT_EQ(run(scratch, {"check", (scratch / "scene.toml").string()}).code, 0);
}

TEST(FitCommand, ExitCodesTellWhatIsWrong) {
  Scratch scratch;
  const std::string file = (scratch / "m.toml").string();
  EXPECT_EQ(run(scratch, {"fit"}).code, 2);
  EXPECT_EQ(run(scratch, {"fit", file}).code, 5);
  write_bytes(scratch / "m.toml", "areal_density = 120\n");
  EXPECT_EQ(run(scratch, {"fit", file}).code, 3);
  write_bytes(scratch / "m.toml", sheet);
  const Outcome onto_itself = run(scratch, {"fit", file, "-o", file});
  EXPECT_EQ(onto_itself.code, 2);
  EXPECT_THAT(onto_itself.err, HasSubstr("name another file with -o"));
  EXPECT_EQ(bytes_of(scratch / "m.toml"), sheet);
  write_bytes(scratch / "warp.csv", "0.01,5\n");
  write_bytes(scratch / "m.toml", sheet + "[[tensile]]\ndirection = \"warp\"\nfile = \"warp.csv\"\n");
  const Outcome onto_points = run(scratch, {"fit", file, "-o", (scratch / "warp.csv").string()});
  EXPECT_EQ(onto_points.code, 2);
  EXPECT_THAT(onto_points.err, HasSubstr("warp.csv: the material would replace its measurements"));
  EXPECT_EQ(bytes_of(scratch / "warp.csv"), "0.01,5\n");
  write_bytes(scratch / "m.toml", sheet);
  EXPECT_EQ(run(scratch, {"fit", file, "-o", (scratch / "no_folder/cloth.toml").string()}).code, 5);
  EXPECT_EQ(run(scratch, {"fit", file, "-o", scratch.path().string()}).code, 5);
  write_bytes(scratch / "m.toml", "name = \"../cloth\"\nareal_density = 0.12\n");
  const Outcome outside = run(scratch, {"fit", file});
  EXPECT_EQ(outside.code, 2);
  EXPECT_THAT(outside.err, HasSubstr("its `name` is not that of a file; name a file with -o"));
}

TEST(FitCommand, WarnsOfTestsThatContradictEachOther) {
  Scratch scratch;
  write_bytes(scratch / "m.toml", sheet + "[[bending]]\ndirection = \"warp\"\nrigidity = 1e-4\n");
  const Outcome outcome =
      run(scratch, {"fit", (scratch / "m.toml").string(), "-o", (scratch / "out.toml").string(), "--quiet"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("muslin: warning: measurements contradict each other: the bending "
                                     "rigidity along warp is"));
  EXPECT_THAT(outcome.err, HasSubstr("[[bending]] 1 ("));
}

TEST(FitCommand, ReadsTheExample) {
  Scratch scratch;
  // Without its drape, which is simulated for some seconds.
  std::string text = bytes_of(test::source / "examples/fitting/shirting.toml");
  text.erase(text.find("[drape]"));
  for (const auto& entry : std::filesystem::directory_iterator(test::source / "examples/fitting"))
    if (entry.path().extension() == ".csv")
      std::filesystem::copy_file(entry.path(), scratch / entry.path().filename().string());
  write_bytes(scratch / "shirting.toml", text);
  const std::string file = (scratch / "out.toml").string();
  const Outcome outcome = run(scratch, {"fit", (scratch / "shirting.toml").string(), "-o", file});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("3 strip tests"));
}

}  // namespace
}  // namespace muslin
