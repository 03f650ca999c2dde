// muslin build SCENE.toml -o DIR
#include <memory>

#include "command.hpp"
#include "progress_line.hpp"

#include "muslin/hosts.hpp"

namespace muslin::app {

void add_build(CLI::App& program) {
  struct Arguments {
    std::string scene, directory;
    int threads = 0;
    bool quiet = false;
    std::vector<std::string> set;
  };
  auto* command = program.add_subcommand("build", "write every stage between mesh and simulation to files");
  auto a = std::make_shared<Arguments>();
  command->add_option("SCENE", a->scene, "scene file (.toml)")->required();
  command->add_option("-o,--output", a->directory, "folder for the stages")->required();
  command->add_option("--threads", a->threads, "threads (default: one per core)")
      ->check(non_negative_integer());
  command->add_option("--set", a->set, "KEY=VALUE overrides a setting")->allow_extra_args(false);
  command->add_flag("--quiet", a->quiet, "no progress");
  command->callback([a] {
    listen_for_interrupts();
    set_thread_count(a->threads);
    ProgressLine line(a->quiet);
    const Model model = build_model(read_scene(a->scene, a->set), line.progress());
    for (const std::string& warning : model.warnings)
      std::fprintf(stderr, "muslin: warning: %s\n", warning.c_str());
    write_stages(a->directory, model, line.progress());
    line.finish();
    if (!a->quiet) print(describe_text(model));
  });
}

}  // namespace muslin::app
