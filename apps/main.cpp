// The muslin program: maps the command line to the library and errors to exit codes.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "command.hpp"

#include "muslin/core/error.hpp"
#include "muslin/core/nearest_name.hpp"
#include "muslin/version.hpp"

namespace muslin::app {
namespace {

volatile std::sig_atomic_t signalled = 0;

void on_signal(int) {
  if (signalled) std::_Exit(static_cast<int>(ErrorKind::interrupted));  // second signal: exit at once
  signalled = 1;
}

/// Advice for a command line that CLI11 cannot parse.
std::string advice(const CLI::App& program, int argc, char** argv) {
  const std::vector<CLI::App*> chosen = program.get_subcommands();
  if (chosen.empty()) {
    if (argc < 2 || argv[1][0] == '-') return "see muslin --help";
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
    return name_advice(argv[1], names);
  }
  const CLI::App& command = *chosen.front();
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const std::string& word : command.remaining()) {
    if (!word.starts_with("--")) continue;
    const auto near = nearest_name(word.substr(0, word.find('=')), names);
    if (near) return "did you mean `" + *near + "`?";
  }
  return "see muslin " + command.get_name() + " --help";
}

int fail(const std::string& message, int code) {
  std::fprintf(stderr, "muslin: %s\n", message.c_str());
  return code;
}

}  // namespace

bool interrupted() { return signalled != 0; }

void listen_for_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw Error(ErrorKind::file, "cannot write to standard output", "check the disk or the pipe it goes to");
}

int run(int argc, char** argv) {
  CLI::App program{"muslin turns any mesh into simulated cloth or soft solid."};
  program.set_version_flag("--version", std::string("muslin ") + version());
  program.require_subcommand(1);
  program.fallthrough(false);
  add_run(program);
  add_check(program);
  add_build(program);
  add_field(program);
  add_render(program);
  add_view(program);
  add_report(program);
  add_fit(program);
  add_export(program);
  add_blender_addon(program);
  add_sweep(program);
  add_materials(program);
  add_schema(program);
  add_verify(program);

  try {
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& help) {
    program.exit(help);
    return 0;
  } catch (const CLI::ParseError& error) {
    std::string problem = error.what();
    if (argc > 1 && argv[1][0] != '-' && program.get_subcommands().empty())
      problem = "there is no command `" + std::string(argv[1]) + "`";
    std::replace(problem.begin(), problem.end(), '\n', ' ');
    return fail(problem + "; " + advice(program, argc, argv), static_cast<int>(ErrorKind::usage));
  } catch (const Error& error) {
    return fail(error.what(), static_cast<int>(error.kind()));
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(error.path1().string() + ": " + error.code().message() + "; check the path",
                static_cast<int>(ErrorKind::file));
  } catch (const std::bad_alloc&) {
    return fail("out of memory; choose a larger voxel_width", static_cast<int>(ErrorKind::solver));
  } catch (const std::exception& error) {
    return fail(std::string("internal error: ") + error.what() + "; please report this with the scene",
                static_cast<int>(ErrorKind::solver));
  }
}

}  // namespace muslin::app

// NOLINTNEXTLINE(bugprone-exception-escape): only if memory for the message of an error runs out
int main(int argc, char** argv) { return muslin::app::run(argc, argv); }
