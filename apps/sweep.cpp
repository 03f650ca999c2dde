// muslin sweep SWEEP.toml: executed by the Python package, `python3 -m muslin.sweeps`.
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command.hpp"
#include <fmt/format.h>
#include <unistd.h>

#include "muslin/core/error.hpp"

namespace muslin::app {
namespace {

/// Python's part: without the package, the message of a command that lacks it.
constexpr const char* script =
    "import sys\n"
    "try:\n"
    "    from muslin.sweeps.__main__ import main\n"
    "except ImportError as error:\n"
    "    sys.stderr.write(f'muslin: sweeps need the Python package, and {sys.executable} says: {error}; '\n"
    "                     'pip install muslin[sweep], or name another Python with MUSLIN_PYTHON\\n')\n"
    "    sys.exit(2)\n"
    "sys.exit(main())\n";

/// MUSLIN_PYTHON, or python3 beside the program, as in a virtual environment, or that of the path.
std::string python() {
  const char* named = std::getenv("MUSLIN_PYTHON");
  if (named != nullptr && *named != '\0') return named;
  std::error_code code;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", code);
  const std::filesystem::path beside = program.parent_path() / "python3";
  return !code && ::access(beside.c_str(), X_OK) == 0 ? beside.string() : "python3";
}

void sweep(const std::vector<std::string>& words) {
  std::string interpreter = python();
  std::vector<std::string> arguments = {interpreter, "-c", script};
  arguments.insert(arguments.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execvp(interpreter.c_str(), pointers.data());
  throw Error(ErrorKind::usage, fmt::format("sweeps need Python, and `{}` cannot be started", interpreter),
              "install Python 3 and muslin[sweep] in it, or name it with MUSLIN_PYTHON");
}

}  // namespace

void add_sweep(CLI::App& program) {
  auto* command = program.add_subcommand("sweep", "run a scene many times with other values of its keys");
  command->prefix_command();
  command->set_help_flag();
  command->callback([command] { sweep(command->remaining()); });
}

}  // namespace muslin::app
