// muslin report: files, exit codes, what is printed.
#include "apps/program.hpp"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace muslin {
namespace {

using test::bytes_of;
using test::Outcome;
using test::run;
using test::Scratch;
using test::two_corners;
using testing::HasSubstr;

std::string flag_run(const Scratch& scratch) {
  const std::string directory = (scratch / "flag").string();
  EXPECT_EQ(run(scratch, {"run", two_corners, "-o", directory, "--frames", "2", "--quiet"}).code, 0);
  return directory;
}

TEST(ReportCommand, WritesPageAndJsonIntoTheRun) {
  Scratch scratch;
  const std::string flag = flag_run(scratch);
  const Outcome outcome =
      run(scratch, {"report", flag, "--no-pictures", "--junit", (scratch / "out.xml").string()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("kept          The run is complete: 3 of 3 frames are there, "));
  EXPECT_THAT(outcome.out, HasSubstr(", as `--frames 2` asked.\n"));
  EXPECT_THAT(outcome.out, HasSubstr("report.html\n"));
  EXPECT_THAT(bytes_of(scratch / "flag/report.html"), HasSubstr("Thesis experiment 2"));
  EXPECT_EQ(nlohmann::json::parse(bytes_of(scratch / "flag/report.json"))["run"]["frames"], 3);
  EXPECT_THAT(bytes_of(scratch / "out.xml"), HasSubstr("failures=\"0\""));
}

TEST(ReportCommand, PrintsJsonAlone) {
  Scratch scratch;
  const std::string flag = flag_run(scratch), page = (scratch / "page.html").string();
  const Outcome outcome =
      run(scratch, {"report", flag, "-o", page, "--json", "-", "--no-pictures", "--quiet"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["promises"].size(), 10u);
  EXPECT_TRUE(std::filesystem::exists(page));
  EXPECT_FALSE(std::filesystem::exists(scratch / "page.json"));
}

TEST(ReportCommand, PrintsTestResultsAlone) {
  Scratch scratch;
  const std::string flag = flag_run(scratch);
  const Outcome outcome = run(scratch, {"report", flag, "--junit", "-", "--no-pictures", "--quiet"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::StartsWith("<?xml"));
  EXPECT_THAT(outcome.out, testing::EndsWith("</testsuites>\n"));
  EXPECT_FALSE(std::filesystem::exists("-"));
  EXPECT_EQ(run(scratch, {"report", flag, "--junit", "-", "--json", "-", "--no-pictures"}).code, 2);
}

TEST(ReportCommand, StrictMakesABrokenPromiseAnError) {
  Scratch scratch;
  const std::string flag = flag_run(scratch);
  EXPECT_EQ(run(scratch, {"report", flag, "--no-pictures", "--strict"}).code, 0);
  std::string summary = bytes_of(scratch / "flag/run.json");
  summary.replace(summary.find("\"finished\""), 10, "\"failed\"");
  test::write_bytes(scratch / "flag/run.json", summary);
  EXPECT_EQ(run(scratch, {"report", flag, "--no-pictures"}).code, 0);
  const Outcome outcome = run(scratch, {"report", flag, "--no-pictures", "--strict", "--quiet"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("1 of 10 promises are broken; see "));
}

TEST(ReportCommand, RefusesWhatIsNoRunAndNoPage) {
  Scratch scratch;
  const Outcome missing = run(scratch, {"report", (scratch / "nothing").string()});
  EXPECT_EQ(missing.code, 5);
  EXPECT_THAT(missing.err, HasSubstr("there is no run here"));
  EXPECT_EQ(run(scratch, {"report", flag_run(scratch), "-o", "page.pdf"}).code, 2);
}

}  // namespace
}  // namespace muslin
