// muslin view RUN
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "progress_line.hpp"
#include <fmt/format.h>

#include "muslin/hosts.hpp"

namespace muslin::app {

void add_view(CLI::App& program) {
  struct Arguments {
    std::string run, page;
    double max_size = 16;
    bool quiet = false;
  };
  auto* command = program.add_subcommand("view", "write one HTML page that plays a run in a browser");
  auto a = std::make_shared<Arguments>();
  command->add_option("RUN", a->run, "run directory")->required();
  command->add_option("-o,--output", a->page, "PAGE.html (default: RUN/view.html)");
  command
      ->add_option("--max-size", a->max_size,
                   "size limit of the page [MB]; frames of a larger run are left out (default: 16)")
      ->check(positive_number());
  command->add_flag("--quiet", a->quiet, "no progress");
  command->callback([a] {
    namespace fs = std::filesystem;
    listen_for_interrupts();
    const fs::path page = a->page.empty() ? fs::path(a->run) / "view.html" : fs::path(a->page);
    if (page.extension() != ".html" && page.extension() != ".htm")
      throw Error(ErrorKind::usage, {page.string()}, "a page must end in .html", "name it PAGE.html");
    ViewOptions options;
    options.largest_bytes = static_cast<std::uint64_t>(1e6 * std::min(a->max_size, 1e6));
    const RunReader run(a->run);
    if (page.has_parent_path()) fs::create_directories(page.parent_path());
    ProgressLine line(a->quiet);
    const ViewReport report = write_view(run, page, options, line.progress());
    line.finish();
    if (a->quiet) return;
    std::string text;
    for (const std::string& note : report.notes) text += note + "\n";
    text += fmt::format("{} ({:.1f} MB, {} frames)\n", page.string(), static_cast<double>(report.bytes) / 1e6,
                        report.frames);
    print(text);
  });
}

}  // namespace muslin::app
