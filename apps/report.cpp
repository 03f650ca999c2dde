// muslin report RUN
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "progress_line.hpp"
#include <fmt/format.h>

#include "muslin/hosts.hpp"
#include "muslin/report/write_report.hpp"

namespace muslin::app {
namespace {

struct ReportArguments {
  std::string run, page, json, junit;
  bool no_pictures = false, strict = false, quiet = false;
};

std::string summary(const RunReport& report) {
  std::string text;
  for (const Promise& promise : report.promises)
    text += fmt::format("{:<13} {}: {}\n", name_of(promise.verdict), promise.title, promise.finding);
  return text;
}

void report(const ReportArguments& a) {
  namespace fs = std::filesystem;
  listen_for_interrupts();
  const bool json_is_printed = a.json == "-", junit_is_printed = a.junit == "-";
  if (json_is_printed && junit_is_printed)
    throw Error(ErrorKind::usage, "--json and --junit cannot both be printed", "name a file for one of them");
  ReportFiles files;
  files.page = a.page.empty() ? fs::path(a.run) / "report.html" : fs::path(a.page);
  if (files.page.extension() != ".html" && files.page.extension() != ".htm")
    throw Error(ErrorKind::usage, {files.page.string()}, "a page must end in .html", "name it PAGE.html");
  if (!json_is_printed)
    files.json = a.json.empty() ? fs::path(files.page).replace_extension(".json") : fs::path(a.json);
  if (!junit_is_printed) files.junit = a.junit;
  files.pictures = !a.no_pictures;
  const RunReader run(a.run);
  ProgressLine line(a.quiet);
  const RunReport made = write_report(run, files, line.progress());
  line.finish();
  if (json_is_printed) {
    print(report_json(run, made).dump(2) + "\n");
  } else if (junit_is_printed) {
    print(report_junit(made));
  } else if (!a.quiet) {
    std::string text = summary(made);
    for (const fs::path& file : {files.page, files.json, files.junit})
      if (!file.empty()) text += file.string() + "\n";
    print(text);
  }
  const std::size_t broken = made.count(Verdict::broken);
  if (a.strict && broken > 0)
    throw Error(ErrorKind::solver, {a.run},
                fmt::format("{} of {} promises are broken", broken, made.promises.size()),
                "see " + files.page.string());
}

}  // namespace

void add_report(CLI::App& program) {
  auto* command =
      program.add_subcommand("report", "write a certificate of a run: one page, with a verdict per promise");
  auto a = std::make_shared<ReportArguments>();
  command->add_option("RUN", a->run, "run directory")->required();
  command->add_option("-o,--output", a->page, "PAGE.html (default: RUN/report.html)");
  command->add_option("--json", a->json,
                      "FILE for programs, - to print it (default: PAGE.json beside the page)");
  command->add_option("--junit", a->junit, "FILE.xml of test results, for pipelines; - to print it");
  command->add_flag("--strict", a->strict, "exit code 4 if a promise is broken");
  command->add_flag("--no-pictures", a->no_pictures, "a page without pictures, sooner");
  command->add_flag("--quiet", a->quiet, "no progress, no summary");
  command->callback([a] { report(*a); });
}

}  // namespace muslin::app
