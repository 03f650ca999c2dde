// muslin fit MEASUREMENTS.toml
#include "muslin/fit/fit.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "progress_line.hpp"
#include <fmt/format.h>

#include "muslin/core/output_file.hpp"

namespace muslin::app {
namespace {

struct FitArguments {
  std::string measurements, output;
  DrapeOptions drape;
  bool quiet = false;
};

void fit(const FitArguments& a) {
  listen_for_interrupts();
  const Measurements measurements = read_measurements(a.measurements);
  const std::filesystem::path file = a.output.empty() ? measurements.name + ".toml" : a.output;
  if (a.output.empty() && (measurements.name.empty() || file.filename() != file))
    throw Error(ErrorKind::usage, {a.measurements}, "its `name` is not that of a file",
                "name a file with -o");
  std::error_code ignored;
  for (const std::filesystem::path& read : measurements.files)
    if (std::filesystem::equivalent(file, read, ignored))
      throw Error(ErrorKind::usage, {read.string()}, "the material would replace its measurements",
                  "name another file with -o");
  // Before the drapes, which take long.
  if (std::filesystem::is_directory(file, ignored) ||
      !std::filesystem::is_directory(file.has_parent_path() ? file.parent_path() : ".", ignored))
    throw Error(ErrorKind::file, {file.string()}, "cannot be written", "name a file in a folder that exists");
  ProgressLine line(a.quiet);
  const Fit made = fit_fabric(measurements, a.drape, line.progress());
  line.finish();
  write_atomically(file, made.text);
  for (const std::string& warning : made.warnings)
    std::fprintf(stderr, "muslin: warning: %s\n", warning.c_str());
  if (!a.quiet) print(fit_table(made) + file.string() + "\n");
}

}  // namespace

void add_fit(CLI::App& program) {
  auto* command = program.add_subcommand("fit", "fit a fabric to measurements and write its material file");
  auto a = std::make_shared<FitArguments>();
  command->add_option("MEASUREMENTS", a->measurements, "file of measurements (.toml)")->required();
  command->add_option("-o,--output", a->output, "material file (default: NAME.toml)");
  command
      ->add_option("--rings", a->drape.rings, "cells of the cloth from its support to its edge (default: 9)")
      ->check(CLI::Range(3, 40));
  command->add_option("--drops", a->drape.drops, "simulated drapes that are averaged (default: 2)")
      ->check(CLI::Range(1, 20));
  command->add_flag("--quiet", a->quiet, "no progress, no table");
  command->callback([a] { fit(*a); });
}

}  // namespace muslin::app
