// muslin run SCENE.toml
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "progress_line.hpp"
#include <fmt/format.h>

#include "muslin/hosts.hpp"

namespace muslin::app {
namespace {

struct RunArguments {
  std::string scene;
  std::string directory;
  int frames = -1;
  int threads = 0;
  bool resume = false;
  bool allow_tangled = false;
  int resume_from = -1;
  bool keep_states = false;
  bool quiet = false;
  std::vector<std::string> set;
};

void run(const RunArguments& arguments) {
  listen_for_interrupts();
  set_thread_count(arguments.threads);
  RunOptions options;
  options.directory = arguments.directory.empty()
                          ? std::filesystem::path("out") / std::filesystem::path(arguments.scene).stem()
                          : std::filesystem::path(arguments.directory);
  options.overrides = arguments.set;
  options.frames = arguments.frames;
  options.resume = arguments.resume || arguments.resume_from >= 0;
  options.resume_from = arguments.resume_from;
  options.allow_tangled = arguments.allow_tangled;
  options.keep_states = arguments.keep_states;
  options.cancelled = [] { return interrupted(); };
  RunResult result;
  {
    ProgressLine line(arguments.quiet);
    options.report = [&](const RunProgress& progress) {
      const std::string frame = progress.stage == "simulation"
                                    ? fmt::format("frame {} of {}", progress.frame, progress.total)
                                    : progress.stage;
      line.show(progress.fraction, frame);
    };
    try {
      result = run_scene(arguments.scene, options);
    } catch (const Error& error) {
      line.finish();
      if (error.kind() != ErrorKind::interrupted) throw;
      throw Error(ErrorKind::interrupted, error.problem(),
                  fmt::format("resume with: muslin run {} -o {} --resume", arguments.scene,
                              options.directory.string()));
    }
  }
  for (const std::string& warning : result.warnings)
    std::fprintf(stderr, "muslin: warning: %s\n", warning.c_str());
  for (const std::string& change : result.changes)
    std::fprintf(stderr, "muslin: resumed with %s\n", change.c_str());
  write_run_plots(RunReader(options.directory));
  if (!arguments.quiet)
    print(fmt::format("{}: frames {} to {}\n", options.directory.string(), result.first_frame,
                      result.last_frame));
}

}  // namespace

void add_run(CLI::App& program) {
  auto* command = program.add_subcommand("run", "simulate a scene and write its run directory");
  auto arguments = std::make_shared<RunArguments>();
  command->add_option("SCENE", arguments->scene, "scene file (.toml)")->required();
  command->add_option("-o,--output", arguments->directory, "run directory (default: out/SCENE)");
  command->add_option("--frames", arguments->frames, "last frame (default: the scene's)")
      ->check(non_negative_integer());
  command
      ->add_option("--threads", arguments->threads,
                   "threads (default: one per core); results do not depend on it")
      ->check(non_negative_integer());
  command->add_flag("--resume", arguments->resume, "continue from the last checkpoint");
  command
      ->add_option("--resume-from", arguments->resume_from, "resume from this frame, with the current scene")
      ->check(non_negative_integer());
  command->add_flag("--keep-states", arguments->keep_states,
                    "keep the state of every frame for --resume-from");
  command->add_option("--set", arguments->set, "KEY=VALUE overrides a setting, e.g. time.duration=2")
      ->allow_extra_args(false);
  command->add_flag("--allow-tangled", arguments->allow_tangled,
                    "start although surfaces cross; these do not touch until they part");
  command->add_flag("--quiet", arguments->quiet, "no progress, only errors and warnings");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace muslin::app
