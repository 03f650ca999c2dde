// The report tells what a run was made of, judges every promise by the evidence, and finds what is spoiled.
#include "muslin/report/run_report.hpp"

#include <cmath>
#include <limits>
#include <set>

#include "report/falling_sheet.hpp"
#include "support/markup.hpp"
#include <gmock/gmock.h>

#include "muslin/cache/run_writer.hpp"
#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using test::bytes_of;
using test::run_sheet;
using test::Scratch;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::ordered_json;

RunReport report_on(const std::filesystem::path& directory) { return make_report(RunReader(directory), {}); }

Json json_of(const std::filesystem::path& directory) {
  const RunReader run(directory);
  return report_json(run, make_report(run, {}));
}

const Promise& promise(const RunReport& report, const std::string& key) {
  for (const Promise& each : report.promises)
    if (each.key == key) return each;
  throw std::invalid_argument(key);
}

Json number(const Json& fabric, const std::string& key) {
  for (const Json& each : fabric["numbers"])
    if (each["key"] == key) return each;
  return {};
}

TEST(RunReport, KeepsEveryPromiseOfAGoodRun) {
  Scratch scratch;
  const RunReport report = report_on(run_sheet(scratch));
  std::set<std::string> kept;
  for (const Promise& each : report.promises) {
    EXPECT_NE(each.verdict, Verdict::broken) << each.title << ": " << each.finding;
    EXPECT_THAT(each.frames, IsEmpty());
    if (each.verdict == Verdict::kept) kept.insert(each.key);
  }
  EXPECT_THAT(kept, testing::UnorderedElementsAre("complete", "finite", "steps_converge", "energy_closes",
                                                  "nothing_crosses", "gaps_stay_open", "nothing_penetrates",
                                                  "stretch_limit_holds", "paths_are_followed"));
  EXPECT_THAT(promise(report, "momentum_is_consistent").finding, HasSubstr("colliders"));
  const RunReport denim = report_on(run_sheet(scratch, test::ball_and_floor + test::gravity, test::sheet_body,
                                              {"body.sheet.material=denim"}));
  EXPECT_EQ(promise(denim, "stretch_limit_holds").finding, "No shell has a `stretch_limit`.");
}

TEST(RunReport, JsonHoldsWhatWasSimulatedAndWhatCameOut) {
  Scratch scratch;
  const Json json = json_of(run_sheet(scratch));
  EXPECT_EQ(json["format"], 1);
  EXPECT_EQ(json["verdict"]["broken"], 0);
  EXPECT_EQ(json["promises"].size(), 10u);
  for (const Json& each : json["promises"])
    for (const char* key :
         {"key", "title", "verdict", "finding", "limit", "measured", "allowed", "unit", "frames"})
      EXPECT_TRUE(each.contains(key)) << key;
  EXPECT_EQ(json["run"]["status"], "finished");
  EXPECT_EQ(json["run"]["frames"], 4);
  EXPECT_EQ(json["run"]["frames_planned"], 4);
  EXPECT_EQ(json["statistics"]["bodies"][0]["triangles"], 72);
  EXPECT_EQ(json["scene"]["time"]["duration"], 0.125);
  EXPECT_TRUE(json["crossings"]["searched"]);
  EXPECT_GT(json["crossings"]["triangles"], 72);
  EXPECT_EQ(json["convergence"]["steps"], json["convergence"]["converged_steps"]);
  EXPECT_GT(json["energy"]["turned_over"], 0.0);
  EXPECT_LT(json["energy"]["share"], 0.01);
  EXPECT_EQ(json["largest_stretch"]["body"], "sheet");
  EXPECT_EQ(json["largest_stretch"]["at"].size(), 3u);
  // The sheet comes to rest on the ball below its middle.
  const Json gap = json["smallest_gap"]["at_end_of_frame"];
  EXPECT_GT(gap["size"], 0.0);
  EXPECT_EQ(gap["bodies"], Json({"sheet", "ball"}));
  EXPECT_NEAR(gap["at"][0], 0, 0.06);
  EXPECT_NEAR(gap["at"][1], 0.2, 0.02);
}

TEST(RunReport, TracesTheNumbersOfFabrics) {
  Scratch scratch;
  const Json library = json_of(run_sheet(scratch))["fabrics"][0];
  EXPECT_EQ(library["material"], "cotton");
  EXPECT_THAT(library["source"], HasSubstr("Codimensional Incremental Potential Contact"));
  const Json bending = number(library, "bending_warp");
  EXPECT_EQ(bending["value"], 1.2e-5);
  EXPECT_EQ(bending["unit"], "N·m");
  EXPECT_THAT(bending["meaning"], HasSubstr("when warp bends"));
  EXPECT_EQ(bending["origin"], "from the material library");
  EXPECT_TRUE(bending["guess"]);
  EXPECT_FALSE(number(library, "poisson")["guess"]);
  EXPECT_EQ(number(library, "mass_damping")["origin"], "derived or default");

  std::string body = test::sheet_body;
  body.replace(body.find("\"cotton\""), 8, "{ base = \"cotton\", areal_density = 0.2 }");
  const Json changed = json_of(run_sheet(scratch, test::ball_and_floor + test::gravity, body,
                                         {"body.sheet.material.bending_weft=1e-5"}))["fabrics"][0];
  EXPECT_EQ(number(changed, "areal_density")["origin"], "from the scene file");
  EXPECT_EQ(number(changed, "bending_weft")["origin"], "overridden by --set or a program");
  EXPECT_FALSE(number(changed, "bending_weft")["guess"]);
  EXPECT_EQ(number(changed, "bending_warp")["origin"], "from the material library");

  const Json other = json_of(run_sheet(scratch, test::ball_and_floor + test::gravity, test::sheet_body,
                                       {"body.sheet.material=silk"}))["fabrics"][0];
  EXPECT_EQ(other["material"], "silk");
  EXPECT_EQ(number(other, "areal_density")["value"], 0.06);
  EXPECT_EQ(number(other, "areal_density")["origin"], "from the material library");
}

TEST(RunReport, OpensAMaterialFileBesideTheScene) {
  Scratch scratch;
  test::write_bytes(scratch / "linen.toml",
                    "source = \"a mill\"\nguesses = [\"shell.poisson\"]\n[shell]\nareal_density = 0.2\n"
                    "membrane_warp = 500\npoisson = 0.3\nbending_warp = 1e-5\n");
  std::string body = test::sheet_body;
  body.replace(body.find("\"cotton\""), 8, "\"linen.toml\"");
  const auto run = run_sheet(scratch, test::ball_and_floor + test::gravity, body);
  const Json fabric = json_of(run)["fabrics"][0];
  EXPECT_EQ(fabric["source"], "a mill");
  EXPECT_EQ(number(fabric, "membrane_warp")["origin"], "from the material file");
  EXPECT_TRUE(number(fabric, "poisson")["guess"]);
  EXPECT_FALSE(number(fabric, "membrane_warp")["guess"]);
  std::filesystem::remove(scratch / "linen.toml");
  EXPECT_EQ(number(json_of(run)["fabrics"][0], "membrane_warp")["origin"],
            "from a material file that was not found again, or derived");
}

TEST(RunReport, FindsASheetThatCrossesItself) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  // An edge is folded over and pierces the sheet beside the ball.
  test::move_points(run / "sheet.skin.pc2", 2, [](auto& points) {
    const Eigen::Vector3f middle = (points[32] + points[40]) / 2;
    points[0] = middle + Eigen::Vector3f(0, 0.03F, 0);
    points[1] = middle - Eigen::Vector3f(0, 0.03F, 0.001F);
  });
  const RunReport report = report_on(run);
  const Promise& crossing = promise(report, "nothing_crosses");
  EXPECT_EQ(crossing.verdict, Verdict::broken);
  EXPECT_THAT(crossing.frames, ElementsAre(2));
  EXPECT_GE(*crossing.measured, 1);
  EXPECT_THAT(crossing.finding, HasSubstr("\"sheet\""));
  EXPECT_EQ(promise(report, "complete").verdict, Verdict::kept);
}

TEST(RunReport, FindsAPointInABallAndOneBeneathAFloor) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  test::move_points(run / "sheet.skin.pc2", 1, [](auto& points) { points[24].y() = 0.15F; });
  test::move_points(run / "sheet.skin.pc2", 3, [](auto& points) { points[0].y() = -0.001F; });
  const RunReport report = report_on(run);
  EXPECT_THAT(promise(report, "nothing_crosses").frames, ElementsAre(1, 3));
  EXPECT_THAT(report.evidence.crossing_frames[0].places[0], HasSubstr("\"ball\""));
  EXPECT_THAT(report.evidence.crossing_frames[1].places[0], HasSubstr("\"floor\""));
}

TEST(RunReport, FindsABallThatMovedIntoTheSheet) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  test::move_points(run / "ball.skin.pc2", 1, [](auto& points) {
    for (auto& point : points) point.y() += 0.05F;
  });
  EXPECT_THAT(promise(report_on(run), "nothing_crosses").frames, ElementsAre(1));
}

TEST(RunReport, NamesFramesThatAreNotFinite) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  test::move_points(run / "sheet.skin.pc2", 2, [](auto& points) { points[5].x() = std::nanf(""); });
  const RunReport report = report_on(run);
  EXPECT_EQ(promise(report, "finite").verdict, Verdict::broken);
  EXPECT_THAT(promise(report, "finite").frames, ElementsAre(2));
  EXPECT_EQ(promise(report, "nothing_crosses").verdict, Verdict::kept);
}

TEST(RunReport, NamesFramesWhoseEnergyIsNotANumber) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  const std::string table = bytes_of(run / "diagnostics.csv");
  const std::size_t kinetic = table.find(',', table.find("\n2,") + 3) + 1;
  test::write_bytes(run / "diagnostics.csv",
                    table.substr(0, kinetic) + "nan" + table.substr(table.find(',', kinetic)));
  EXPECT_THAT(promise(report_on(run), "finite").frames, ElementsAre(2));
}

TEST(RunReport, HoldsMomentumAgainstTheImpulseOfGravity) {
  Scratch scratch;
  const auto run = run_sheet(scratch, test::gravity);
  const RunReport fall = report_on(run);
  const Promise& momentum = promise(fall, "momentum_is_consistent");
  EXPECT_EQ(momentum.verdict, Verdict::kept) << momentum.finding;
  EXPECT_LT(*momentum.measured, 1e-6);
  EXPECT_THAT(promise(fall, "nothing_crosses").finding, HasSubstr("no contact"));
  EXPECT_EQ(promise(fall, "gaps_stay_open").verdict, Verdict::not_measured);
  EXPECT_EQ(promise(fall, "nothing_penetrates").verdict, Verdict::not_measured);
  test::replace_in(run / "stats.json", "\"mass\": 0.05", "\"mass\": 0.06");
  EXPECT_EQ(promise(report_on(run), "momentum_is_consistent").verdict, Verdict::broken);
  // Nothing moves a sheet without gravity.
  EXPECT_EQ(promise(report_on(run_sheet(scratch, "")), "momentum_is_consistent").verdict, Verdict::kept);
}

TEST(RunReport, JudgesWhatTheTablesSay) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  // Frame 3: a step that missed its tolerance, a closed gap, two vertices held back by up to 4.2 mm, a depth
  // of 1 mm.
  std::string table = bytes_of(run / "diagnostics.csv");
  std::size_t at = table.rfind('\n', table.size() - 2) + 1;
  std::vector<std::string> fields;
  std::istringstream row(table.substr(at));
  for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
  fields[14] = "-0.002";
  fields[17] = "0";
  fields[19] = "1000";
  fields[21] = "2";
  fields[22] = "0.001";
  fields[23] = "0.0042\n";
  std::string spoiled;
  for (const std::string& field : fields) spoiled += (spoiled.empty() ? "" : ",") + field;
  test::write_bytes(run / "diagnostics.csv", table.substr(0, at) + spoiled);
  const RunReport report = report_on(run);
  for (const char* key :
       {"steps_converge", "energy_closes", "gaps_stay_open", "nothing_penetrates", "paths_are_followed"}) {
    EXPECT_EQ(promise(report, key).verdict, Verdict::broken) << key;
    EXPECT_THAT(promise(report, key).frames, ElementsAre(3)) << key;
  }
  EXPECT_EQ(promise(report, "gaps_stay_open").measured, -0.002);
  EXPECT_THAT(promise(report, "paths_are_followed").finding,
              HasSubstr("up to 2 vertices in frame 3, by up to 4.2 mm."));
}

TEST(RunReport, HoldsLimitsOfStretch) {
  Scratch scratch;
  const auto run =
      run_sheet(scratch, test::ball_and_floor + test::gravity, test::sheet_body + "stretch_limit = 1.1\n");
  EXPECT_EQ(promise(report_on(run), "stretch_limit_holds").verdict, Verdict::kept);
  test::write_bytes(run / "stretch.csv", bytes_of(run / "stretch.csv") + "3,1.3,1.1,sheet\n");
  const RunReport report = report_on(run);
  EXPECT_EQ(promise(report, "stretch_limit_holds").verdict, Verdict::broken);
  EXPECT_THAT(promise(report, "stretch_limit_holds").frames, ElementsAre(3));
}

TEST(RunReport, TakesRunsThatAreNotFinished) {
  Scratch scratch;
  auto run = run_sheet(scratch);
  test::replace_in(run / "run.json", "\"finished\"", "\"interrupted\"");
  EXPECT_EQ(promise(report_on(run), "complete").verdict, Verdict::broken);
  test::replace_in(run / "run.json", "\"interrupted\"", "\"running\"");
  EXPECT_THAT(promise(report_on(run), "complete").finding, HasSubstr("killed"));
  {
    const auto model = std::make_shared<const Model>(build_model(read_scene(scratch / "scene.toml")));
    Simulation simulation(model);
    RunWriter writer(run, simulation, 3, false);
    simulation.advance();
    writer.write_frame();
    const RunReport report = report_on(run);
    EXPECT_EQ(promise(report, "complete").verdict, Verdict::not_measured);
    EXPECT_THAT(promise(report, "complete").finding, HasSubstr("2 of 4 frames"));
    EXPECT_EQ(promise(report, "nothing_crosses").verdict, Verdict::kept);
  }
}

TEST(RunReport, NamesFramesThatTheTableLacks) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  std::string table = bytes_of(run / "diagnostics.csv");
  const std::size_t second = table.find("\n1,") + 1;
  test::write_bytes(run / "diagnostics.csv", table.erase(second, table.find('\n', second) + 1 - second));
  const RunReport report = report_on(run);
  EXPECT_EQ(promise(report, "complete").verdict, Verdict::broken);
  EXPECT_THAT(promise(report, "complete").finding, HasSubstr("3 of 4 frames are there"));
  EXPECT_THAT(promise(report, "complete").frames, ElementsAre(1, 2));
}

TEST(RunReport, TakesRunsOfEarlierVersions) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  Json summary = Json::parse(bytes_of(run / "run.json"));
  summary.erase("contact");
  test::write_bytes(run / "run.json", summary.dump());
  std::istringstream table(bytes_of(run / "diagnostics.csv"));
  std::string old;
  for (std::string line; std::getline(table, line);) {
    std::size_t end = 0;
    for (int column = 0; column < 16; ++column) end = line.find(',', end) + 1;
    old += line.substr(0, end - 1) + "\n";
  }
  test::write_bytes(run / "diagnostics.csv", old);
  const RunReport report = report_on(run);
  for (const char* key : {"steps_converge", "energy_closes", "nothing_crosses", "nothing_penetrates"})
    EXPECT_EQ(promise(report, key).verdict, Verdict::not_measured) << key;
  EXPECT_EQ(promise(report, "gaps_stay_open").verdict, Verdict::kept);
}

TEST(RunReport, RefusesDamagedFiles) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  const std::string summary = bytes_of(run / "run.json");
  const auto expect_input_error = [&] {
    try {
      report_on(run);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_THAT(error.what(), HasSubstr("run.json"));
    }
  };
  test::write_bytes(run / "run.json", summary.substr(0, summary.size() / 2));
  expect_input_error();
  test::write_bytes(run / "run.json", summary);
  test::replace_in(run / "run.json", "\"timings\": {", "\"timings\": 7, \"other\": {");
  expect_input_error();
}

TEST(RunReport, JunitCountsFailuresAndIsWellFormed) {
  Scratch scratch;
  const auto run = run_sheet(scratch);
  test::move_points(run / "sheet.skin.pc2", 2, [](auto& points) { points[24].y() = 0.1F; });
  const std::string xml = report_junit(report_on(run));
  EXPECT_TRUE(test::is_well_formed(xml)) << xml;
  EXPECT_THAT(xml, HasSubstr("<testsuite name=\"A sheet on a &lt;ball&gt;\" tests=\"10\" failures=\"1\" "
                             "errors=\"0\" skipped=\"1\">"));
  EXPECT_THAT(xml, HasSubstr("name=\"nothing_crosses\"><failure message="));
}

}  // namespace
}  // namespace muslin
