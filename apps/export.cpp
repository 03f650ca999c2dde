// muslin export RUN FILE
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "progress_line.hpp"

#include "muslin/hosts.hpp"

namespace muslin::app {

void add_export(CLI::App& program) {
  struct Arguments {
    std::string run, file, body, surface = "skin";
    bool quiet = false;
  };
  auto* command = program.add_subcommand("export", "write a run for other programs");
  auto a = std::make_shared<Arguments>();
  command->add_option("RUN", a->run, "run directory")->required();
  command
      ->add_option("FILE", a->file,
                   "FILE.pc2, .mdd, .obj, .ply, .usda, .glb, .gltf or .vtu; the suffix selects the format")
      ->required();
  command->add_option("--body", a->body, "body to export (default: the only one; .usda: all)");
  command->add_option("--surface", a->surface, "skin (default) or contour")
      ->check(CLI::IsMember({"skin", "contour"}));
  command->add_flag("--quiet", a->quiet, "no progress");
  command->callback([a] {
    listen_for_interrupts();
    ProgressLine line(a->quiet);
    ExportOptions options;
    options.body = a->body;
    options.surface = a->surface == "contour" ? SurfaceKind::contour : SurfaceKind::skin;
    const RunReader run(a->run);
    const std::filesystem::path file(a->file);
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    export_run(run, file, options, line.progress());
  });
}

}  // namespace muslin::app
