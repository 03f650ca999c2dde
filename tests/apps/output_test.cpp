// Output of the program for people and for other programs: tables, stages, exports, pictures.
#include <map>
#include <regex>

#include "apps/program.hpp"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace muslin {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Outcome;
using test::run;
using test::Scratch;
using test::two_corners;
using testing::HasSubstr;

/// A slice as printed: numbers in rows.
std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    rows.emplace_back(std::istream_iterator<std::string>(words), std::istream_iterator<std::string>());
  }
  return rows;
}

TEST(Field, PrintsFigure52OfTheThesis) {
  Scratch scratch;
  const Outcome outcome =
      run(scratch, {"field", (test::scenes / "meshes/thin_flag.obj").string(), "--voxel-width", "1"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto rows = rows_of(outcome.out);
  // Ho 2016, figure 5.2: 13 x 9 samples around the flag; 0.1 m of cloth on every side.
  ASSERT_EQ(rows.size(), 9u) << outcome.out;
  for (std::size_t j = 0; j < 9; ++j) {
    ASSERT_EQ(rows[j].size(), 13u);
    for (std::size_t i = 0; i < 13; ++i) {
      const bool side = i == 0 || i == 12, end = j == 0 || j == 8;
      EXPECT_EQ(rows[j][i], side && end ? "1.273" : side || end ? "0.900" : "-0.100") << i << ", " << j;
    }
  }
}

TEST(Field, RefusesFieldsThatCannotBeSampled) {
  Scratch scratch;
  const std::string mesh = (test::scenes / "meshes/thin_flag.obj").string();
  EXPECT_EQ(run(scratch, {"field", mesh, "--voxel-width", "1e-12"}).code, 2);
  EXPECT_EQ(run(scratch, {"field", mesh, "--voxel-width", "1", "--slice", "z=1e300"}).code, 0);
  EXPECT_EQ(run(scratch, {"field", mesh, "--voxel-width", "1", "--margin", "1000000000"}).code, 2);
}

/// Attributes of the first element with this name in an XML file.
std::string attribute(const std::string& xml, const std::string& element, const std::string& name) {
  std::smatch match;
  const std::string head = xml.substr(0, 4000);
  if (!std::regex_search(head, match, std::regex("<" + element + "[^>]*\\b" + name + "=\"([^\"]*)\"")))
    return "";
  return match[1];
}

TEST(Build, WritesEveryStageWithTheCountsOfTheThesis) {
  Scratch scratch;
  const Outcome outcome = run(scratch, {"build", two_corners, "-o", scratch / "stages", "--quiet"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto xml = [&](const std::string& stage) { return bytes_of(scratch / ("stages/flag." + stage)); };
  EXPECT_EQ(attribute(xml("field.vti"), "VTKFile", "type"), "ImageData");
  EXPECT_EQ(attribute(xml("field.vti"), "ImageData", "WholeExtent"), "0 12 0 8 0 3");
  EXPECT_EQ(attribute(xml("field.vti"), "ImageData", "Spacing"), "1 1 1");
  const std::map<std::string, std::string> cells = {
      {"voxels.vtu", "60"}, {"tets.vtu", "360"}, {"springs.vtu", "665"}};
  for (const auto& [stage, count] : cells) {
    EXPECT_EQ(attribute(xml(stage), "Piece", "NumberOfPoints"), "154") << stage;
    EXPECT_EQ(attribute(xml(stage), "Piece", "NumberOfCells"), count) << stage;
  }
  for (const char* surface : {"skin.obj", "solid.obj", "contour.obj"}) {
    const Outcome check =
        run(scratch, {"check", "--json", scratch / (std::string("stages/flag.") + surface)});
    ASSERT_EQ(check.code, 0) << check.err;
    EXPECT_EQ(nlohmann::json::parse(check.out)["closed"], std::string(surface) != "skin.obj") << surface;
  }
  const auto stats = nlohmann::json::parse(bytes_of(scratch / "stages/stats.json"));
  const auto check = nlohmann::json::parse(run(scratch, {"check", "--json", two_corners}).out);
  EXPECT_EQ(stats["bodies"], check["bodies"]);
}

class Pictures : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root() = fs::temp_directory_path() / ("muslin.pictures." + std::to_string(::getpid()));
    fs::create_directories(root());
    ASSERT_EQ(std::system((std::string(MUSLIN_PROGRAM) + " run --quiet --frames 2 -o '" +
                           (root() / "run").string() + "' '" + two_corners + "'")
                              .c_str()),
              0);
  }
  static void TearDownTestSuite() { fs::remove_all(root()); }
  static fs::path& root() {
    static fs::path path;
    return path;
  }
  static std::string the_run() { return (root() / "run").string(); }
  /// A copy of the run that a test may break.
  static std::string copy(const Scratch& scratch) {
    fs::copy(root() / "run", scratch / "run", fs::copy_options::recursive);
    return scratch / "run";
  }
};

TEST_F(Pictures, OneFrameAMovieAndAFolder) {
  Scratch scratch;
  const std::vector<std::string> small = {"render",    the_run(), "--size",  "64x36",
                                          "--samples", "1",       "--quiet", "-o"};
  const auto render = [&](const std::string& to, std::vector<std::string> more = {}) {
    std::vector<std::string> words = small;
    words.push_back(to);
    words.insert(words.end(), more.begin(), more.end());
    return run(scratch, words);
  };
  ASSERT_EQ(render(scratch / "one.png", {"--frame", "1"}).code, 0);
  EXPECT_EQ(bytes_of(scratch / "one.png").substr(1, 3), "PNG");
  ASSERT_EQ(render(scratch / "frames").code, 0);
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch / "frames"), fs::directory_iterator()), 3);
  EXPECT_EQ(render(scratch / "no.png", {"--frame", "3"}).code, 2);
  EXPECT_EQ(render(scratch / "no.gif").code, 2);
  EXPECT_EQ(render(scratch / "no.png", {"--body", "banner"}).code, 2);
  for (const char* size : {"0x10", "-5x5", "1e3x2", "99999x9", "10", "10x10x10", "999999999999x1"})
    EXPECT_EQ(render(scratch / "no.png", {"--size", size}).code, 2) << size;
  EXPECT_FALSE(fs::exists(scratch / "no.png"));
  ASSERT_EQ(std::system("command -v ffprobe >/dev/null"), 0) << "tools/setup installs ffmpeg";
  ASSERT_EQ(render(scratch / "movie.mp4").code, 0);
  const std::string probe =
      "ffprobe -v error -count_frames -select_streams v -show_entries "
      "stream=width,height,nb_read_frames,pix_fmt -of csv=p=0 '" +
      (scratch / "movie.mp4").string() + "' > '" + (scratch / "probe").string() + "'";
  ASSERT_EQ(std::system(probe.c_str()), 0);
  EXPECT_EQ(bytes_of(scratch / "probe"), "64,36,yuv420p,3\n");
}

TEST_F(Pictures, ExportsEverySuffixAndRefusesOthers) {
  Scratch scratch;
  for (const char* file : {"a.pc2", "a.mdd", "a.usda", "a.glb", "a.gltf"}) {
    ASSERT_EQ(run(scratch, {"export", the_run(), scratch / file, "--quiet"}).code, 0) << file;
    EXPECT_GT(fs::file_size(scratch / file), 100u) << file;
  }
  for (const char* suffix : {".obj", ".ply", ".vtu"}) {
    ASSERT_EQ(run(scratch, {"export", the_run(), scratch / (std::string("s") + suffix), "--quiet"}).code, 0);
    for (const char* frame : {"0000", "0001", "0002"})
      EXPECT_TRUE(fs::exists(scratch / (std::string("s.") + frame + suffix))) << suffix;
  }
  EXPECT_EQ(run(scratch, {"export", the_run(), scratch / "a.abc"}).code, 2);
  EXPECT_EQ(run(scratch, {"export", the_run(), scratch / "a.pc2", "--surface", "bones"}).code, 2);
  EXPECT_EQ(run(scratch, {"export", the_run(), scratch / "new/a.pc2", "--quiet"}).code, 0);
  EXPECT_TRUE(fs::exists(scratch / "new/a.pc2"));
  EXPECT_EQ(run(scratch, {"export", the_run(), scratch / "new/a.pc2/b.pc2", "--quiet"}).code, 5);
  fs::create_directory(scratch / "folder.pc2");
  EXPECT_EQ(run(scratch, {"export", the_run(), scratch / "folder.pc2", "--quiet"}).code, 5);
}

TEST_F(Pictures, BrokenRunsAreErrorsNotCrashes) {
  struct Damage {
    const char* what;
    std::function<void(const fs::path&)> apply;
    std::vector<int> codes;
  };
  const std::vector<Damage> damages = {
      {"no run.json", [](const fs::path& d) { fs::remove(d / "run.json"); }, {5}},
      {"garbage in run.json",
       [](const fs::path& d) { test::write_bytes(d / "run.json", "{\"muslin\": ["); },
       {3}},
      {"bodies of another type",
       [](const fs::path& d) {
         test::write_bytes(d / "run.json", R"({"muslin": 1, "bodies": 3, "frame_rate": "fast"})");
       },
       {3}},
      {"no bodies",
       [](const fs::path& d) {
         test::write_bytes(d / "run.json", R"({"muslin": {}, "bodies": [], "frame_rate": 24})");
       },
       {3}},
      {"a frame rate of 0",
       [](const fs::path& d) {
         auto json = nlohmann::json::parse(bytes_of(d / "run.json"));
         json["frame_rate"] = 0;
         test::write_bytes(d / "run.json", json.dump());
       },
       {3}},
      {"a cache without a frame", [](const fs::path& d) { fs::resize_file(d / "flag.skin.pc2", 32); }, {3}},
      {"a cache cut inside its header",
       [](const fs::path& d) { fs::resize_file(d / "flag.skin.pc2", 7); },
       {3}},
      {"no cache", [](const fs::path& d) { fs::remove(d / "flag.skin.pc2"); }, {5}},
      {"garbage for a mesh",
       [](const fs::path& d) { test::write_bytes(d / "flag.skin.obj", "f 1 2 99\n"); },
       {3}},
      {"garbage for a table",
       [](const fs::path& d) { test::write_bytes(d / "diagnostics.csv", "a,b\n1"); },
       {3}},
      {"an empty lattice file",
       [](const fs::path& d) { test::write_bytes(d / "flag.lattice.vtu", ""); },
       {3}},
  };
  for (const Damage& damage : damages) {
    SCOPED_TRACE(damage.what);
    Scratch scratch;
    const std::string broken = copy(scratch);
    damage.apply(broken);
    for (const auto& words :
         {std::vector<std::string>{"render", broken, "-o", scratch / "x.png", "--size", "32x18"},
          {"export", broken, scratch / "x.usda"}}) {
      const Outcome outcome = run(scratch, words);
      EXPECT_THAT(damage.codes, testing::Contains(outcome.code)) << words[0] << ": " << outcome.err;
      EXPECT_THAT(outcome.err, testing::StartsWith("muslin: " + broken)) << words[0];
      EXPECT_THAT(outcome.err, testing::Not(HasSubstr("internal error")));
    }
  }
  // A cache cut in its second frame still shows the first.
  Scratch scratch;
  const std::string cut = copy(scratch);
  fs::resize_file(fs::path(cut) / "flag.skin.pc2", fs::file_size(fs::path(cut) / "flag.skin.pc2") / 2);
  const Outcome outcome =
      run(scratch, {"render", cut, "-o", scratch / "x.png", "--size", "32x18", "--quiet"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

}  // namespace
}  // namespace muslin
