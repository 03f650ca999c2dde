// muslin verify [TEST]
#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "command.hpp"
#include "verify_case.hpp"
#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/nearest_name.hpp"

namespace muslin::app {
namespace {

std::string list() {
  std::string text;
  for (const VerifyCase& c : verify_cases())
    text += fmt::format("{:<26} {}{}\n", c.name, c.claim, c.slow ? " (slow)" : "");
  return text;
}

/// Returns the case of this name, or all cases whose names begin with it and a hyphen.
std::vector<VerifyCase> find_cases(const std::string& name) {
  std::vector<std::string> names;
  std::vector<VerifyCase> group;
  for (const VerifyCase& c : verify_cases()) {
    if (c.name == name) return {c};
    if (c.name.starts_with(name + "-")) group.push_back(c);
    names.push_back(c.name);
  }
  if (!group.empty()) return group;
  throw Error(ErrorKind::usage, fmt::format("there is no test `{}`", name),
              name_advice(name, names) + " (muslin verify --list)");
}

std::string row(const VerifyCase& c, const Comparison& number) {
  const std::string unit = number.relative ? " %" : "";
  const double scale = number.relative ? 100 : 1;
  return fmt::format(
      "{:<26} {:<44} {:>12.7g} {:>12.7g} {:>10} {:>10}  {}  {}\n", c.name, number.quantity, number.reference,
      number.measured, fmt::format("{:.2g}{}", scale * number.deviation(), unit),
      fmt::format("{:.2g}{}", scale * number.tolerance, unit), number.passed() ? "pass" : "FAIL", c.source);
}

std::string csv_row(const VerifyCase& c, const Comparison& number) {
  return fmt::format("{},\"{}\",{:.17g},{:.17g},{:.17g},{:.17g},{},{},\"{}\"\n", c.name, number.quantity,
                     number.reference, number.measured, number.deviation(), number.tolerance,
                     number.relative ? "relative" : "absolute", number.passed() ? "pass" : "FAIL", c.source);
}

/// Returns the comparisons of the case; a run that the solver aborts gives one failed comparison.
std::vector<Comparison> find(const VerifyCase& c) {
  try {
    return c.run();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::solver) throw;
    return {{error.what(), 0, std::numeric_limits<double>::quiet_NaN(), 0, false}};
  }
}

/// Returns the number of comparisons that failed.
int verify(const std::vector<VerifyCase>& cases, bool csv) {
  print(csv ? "test,quantity,reference,measured,deviation,tolerance,kind,verdict,source\n"
            : fmt::format("{:<26} {:<44} {:>12} {:>12} {:>10} {:>10}  {}  {}\n", "test", "quantity",
                          "reference", "measured", "deviation", "tolerance", "    ", "source"));
  const auto begin = std::chrono::steady_clock::now();
  int count = 0, failed = 0;
  for (const VerifyCase& c : cases) {
    for (const Comparison& number : find(c)) {
      print(csv ? csv_row(c, number) : row(c, number));
      ++count;
      failed += number.passed() ? 0 : 1;
    }
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!csv) print(fmt::format("{} of {} pass ({:.0f} s)\n", count - failed, count, seconds));
  return failed;
}

}  // namespace

void add_verify(CLI::App& program) {
  struct Arguments {
    std::string test;
    bool list = false, csv = false;
  };
  auto* command =
      program.add_subcommand("verify", "compare simulations with closed forms and published numbers");
  auto a = std::make_shared<Arguments>();
  command->add_option("TEST", a->test, "a test, or the first word of several (default: all)");
  command->add_flag("--csv", a->csv, "print comma-separated values with all digits");
  command->add_flag("--list", a->list, "list the tests");
  command->callback([a] {
    if (a->list) return print(list());
    // Ctrl-C ends the program at once: nothing is written that could be lost.
    const int failed = verify(a->test.empty() ? verify_cases() : find_cases(a->test), a->csv);
    if (failed > 0)
      throw Error(ErrorKind::solver, fmt::format("{} of the numbers are out of tolerance", failed),
                  "see the lines with FAIL");
  });
}

}  // namespace muslin::app
