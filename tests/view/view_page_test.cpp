// The page as a file: whole, safe whatever the names are, and below the size that was asked for.
#include "muslin/view/view_page.hpp"

#include <cmath>
#include <filesystem>

#include "cache/scratch.hpp"
#include "support/small_model.hpp"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "muslin/cache/run_writer.hpp"
#include "muslin/core/error.hpp"
#include "muslin/view/page_template.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Scratch;
using testing::HasSubstr;

void write_run(const fs::path& directory, int frames, const std::string& title = "a small flag",
               const std::string& body = "flag") {
  test::SmallModelOptions options;
  options.body_name = body;
  Model model = test::small_model(options);
  model.scene.title = title;
  Simulation simulation(std::make_shared<const Model>(std::move(model)));
  RunWriter writer(directory, simulation, frames, false);
  while (simulation.frame() < frames) {
    simulation.advance();
    writer.write_frame();
  }
  writer.finish(RunStatus::finished);
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  if (from == std::string::npos) return "";
  return text.substr(from + begin.size(), text.find(end, from + begin.size()) - from - begin.size());
}

nlohmann::json head_of(const std::string& page) {
  return nlohmann::json::parse(between(page, "<script id=\"run\" type=\"application/json\">", "</script>"));
}

TEST(ViewPage, HoldsEveryFrameOfASmallRun) {
  Scratch scratch;
  write_run(scratch / "run", 12);
  const ViewReport report = write_view(RunReader(scratch / "run"), scratch / "page.html");
  EXPECT_EQ(report.frames, 13);
  EXPECT_TRUE(report.notes.empty());
  const std::string page = bytes_of(scratch / "page.html");
  EXPECT_EQ(report.bytes, page.size());
  EXPECT_THAT(page, testing::StartsWith("<!doctype html>"));
  EXPECT_THAT(page, testing::Not(HasSubstr("%RUN%")));
  const auto head = head_of(page);
  EXPECT_EQ(head["title"], "a small flag");
  EXPECT_EQ(head["frames"].size(), 13u);
  EXPECT_EQ(head["bodies"][0]["surfaces"].size(), 3u);
  EXPECT_EQ(head["pins"].size(), 1u);
  EXPECT_EQ(head["pins"][0]["until"], 0.6);
}

TEST(ViewPage, IsTheSameWhenWrittenAgain) {
  Scratch scratch;
  write_run(scratch / "run", 5);
  write_view(RunReader(scratch / "run"), scratch / "a.html");
  write_view(RunReader(scratch / "run"), scratch / "b.html");
  EXPECT_TRUE(bytes_of(scratch / "a.html") == bytes_of(scratch / "b.html"));
}

TEST(ViewPage, CannotBeBrokenByTitlesOrNames) {
  Scratch scratch;
  const std::string title = "</title></script><!--<script>alert(\"1\")&%RUN%";
  write_run(scratch / "run", 2, title, "<!--<script>");
  write_view(RunReader(scratch / "run"), scratch / "page.html");
  const std::string page = bytes_of(scratch / "page.html");
  EXPECT_EQ(head_of(page)["title"], title);
  EXPECT_EQ(head_of(page)["bodies"][0]["name"], "<!--<script>");
  EXPECT_EQ(between(page, "<title>", "</title>"),
            "&lt;/title&gt;&lt;/script&gt;&lt;!--&lt;script&gt;alert(&quot;1&quot;)&amp;%RUN%");
  EXPECT_THAT(between(page, "<script id=\"run\"", "</script>"), testing::Not(HasSubstr("<!--")));
}

TEST(ViewPage, RespectsTheSizeLimit) {
  Scratch scratch;
  write_run(scratch / "run", 60);
  const RunReader run(scratch / "run");
  const std::uint64_t whole = write_view(run, scratch / "whole.html").bytes;
  // The page itself and a part of what the run takes.
  const std::uint64_t empty = page_template().size();
  ViewOptions options;
  options.largest_bytes = empty + (whole - empty) / 2;
  const ViewReport report = write_view(run, scratch / "page.html", options);
  EXPECT_LE(report.bytes, options.largest_bytes);
  EXPECT_LT(report.frames, 61);
  EXPECT_GE(report.frames, 2);
  ASSERT_FALSE(report.notes.empty());
  const auto head = head_of(bytes_of(scratch / "page.html"));
  EXPECT_EQ(head["frames"].front(), 0);
  EXPECT_EQ(head["frames"].back(), 60);
  EXPECT_EQ(head["notes"].size(), report.notes.size());
}

TEST(ViewPage, ReportsIfNothingFits) {
  Scratch scratch;
  write_run(scratch / "run", 3);
  ViewOptions options;
  options.largest_bytes = 1000;
  try {
    write_view(RunReader(scratch / "run"), scratch / "page.html", options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_THAT(error.what(), HasSubstr("--max-size"));
  }
  EXPECT_FALSE(fs::exists(scratch / "page.html"));
  EXPECT_FALSE(fs::exists(scratch / "page.html.part"));
}

TEST(ViewPage, RefusesPositionsThatAreNotFinite) {
  Scratch scratch;
  write_run(scratch / "run", 3);
  std::string cache = bytes_of(scratch / "run/flag.skin.pc2");
  const float bad = std::nanf("");
  cache.replace(cache.size() - 4, 4, reinterpret_cast<const char*>(&bad), 4);
  test::write_bytes(scratch / "run/flag.skin.pc2", cache);
  try {
    write_view(RunReader(scratch / "run"), scratch / "page.html");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_THAT(error.what(), HasSubstr("frame 3"));
  }
  EXPECT_FALSE(fs::exists(scratch / "page.html"));
}

}  // namespace
}  // namespace muslin
