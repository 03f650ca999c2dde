// Declares the commands of the program. Each adds its subcommand to the application; its work runs while the
// command line is parsed, and errors leave as muslin::Error.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace muslin::app {

void add_run(CLI::App& program);
void add_check(CLI::App& program);
void add_build(CLI::App& program);
void add_field(CLI::App& program);
void add_render(CLI::App& program);
void add_export(CLI::App& program);
void add_view(CLI::App& program);
void add_blender_addon(CLI::App& program);
void add_report(CLI::App& program);
void add_fit(CLI::App& program);
void add_materials(CLI::App& program);
void add_sweep(CLI::App& program);
void add_schema(CLI::App& program);
void add_verify(CLI::App& program);

/// True once the user pressed Ctrl-C (or the process received a termination signal).
bool interrupted();
void listen_for_interrupts();

/// Writes text to standard output. Errors: file, if it cannot be written (a full disk behind a redirection).
void print(const std::string& text);

/// Validators of option values; their messages state the requirement in words.
CLI::Validator positive_number();
CLI::Validator non_negative_number();
CLI::Validator positive_integer();
CLI::Validator non_negative_integer();

}  // namespace muslin::app
