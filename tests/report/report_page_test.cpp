// The page of a report: everything inside, nothing from outside, safe whatever the names are.
#include "muslin/report/report_page.hpp"

#include "report/falling_sheet.hpp"
#include <gmock/gmock.h>

#include "muslin/report/write_report.hpp"

namespace muslin {
namespace {

using test::bytes_of;
using test::run_sheet;
using test::Scratch;
using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(ReportPage, HoldsEverythingAndAsksForNothing) {
  Scratch scratch;
  const RunReader run(run_sheet(scratch));
  write_report(run, {scratch / "new/page.html", scratch / "page.json", scratch / "page.xml"}, {});
  const std::string page = bytes_of(scratch / "new/page.html");
  EXPECT_THAT(page, testing::StartsWith("<!doctype html>"));
  EXPECT_THAT(page, Not(HasSubstr("%BODY%")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("<link")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  EXPECT_THAT(page, Not(HasSubstr("url(")));
  // Start, middle, end and the largest stretch.
  EXPECT_EQ(count_of(page, "<img "), 4u);
  EXPECT_EQ(count_of(page, "src=\"data:image/png;base64,"), 4u);
  EXPECT_EQ(count_of(page, "src="), 4u);
  EXPECT_EQ(count_of(page, "href="), 0u);
  EXPECT_EQ(count_of(page, "<figure class=\"curve\"><svg"), 6u);
  EXPECT_EQ(count_of(page, "://"), count_of(page, "xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(page, HasSubstr("<span class=\"guess\">guess</span>"));
  EXPECT_THAT(page, Not(HasSubstr("class=\"alarm\">")));
  EXPECT_TRUE(std::filesystem::exists(scratch / "page.json"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "page.xml"));
}

TEST(ReportPage, EscapesNamesAndTitles) {
  Scratch scratch;
  const RunReader run(run_sheet(scratch));
  const std::string page = report_page(run, make_report(run, {}), {});
  EXPECT_THAT(page, HasSubstr("<title>A sheet on a &lt;ball&gt;</title>"));
  EXPECT_THAT(page, Not(HasSubstr("<ball>")));
}

TEST(ReportPage, SaysLoudlyThatARunIsNotFinished) {
  Scratch scratch;
  const auto directory = run_sheet(scratch);
  test::replace_in(directory / "run.json", "\"finished\"", "\"failed\"");
  const RunReader run(directory);
  EXPECT_THAT(report_page(run, make_report(run, {}), {}),
              HasSubstr("class=\"alarm\">This run is not finished"));
}

TEST(ReportPage, IsTheSameWhenWrittenAgain) {
  Scratch scratch;
  const RunReader run(run_sheet(scratch));
  write_report(run, {scratch / "a.html", {}, {}, false}, {});
  write_report(run, {scratch / "b.html", {}, {}, false}, {});
  EXPECT_TRUE(bytes_of(scratch / "a.html") == bytes_of(scratch / "b.html"));
}

}  // namespace
}  // namespace muslin
