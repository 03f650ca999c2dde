// Reports of runs.
#include <optional>
#include <string>

#include "bindings.hpp"
#include "callbacks.hpp"
#include "json.hpp"
#include "paths.hpp"
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nlohmann/json.hpp>

#include "muslin/report/write_report.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

/// Examines the run and writes the files that are named, without the GIL; returns the report as Python has
/// it.
JsonObject write(const RunReader& run, const ReportFiles& files, const Report& progress,
                 const Cancel& cancel) {
  std::string text;
  {
    const nb::gil_scoped_release nogil;
    const RunReport report = write_report(run, files, progress_of(progress, cancel));
    text = report_json(run, report).dump();
  }
  return from_json(text);
}

}  // namespace

void bind_run_report(nb::module_& m) {
  using Path = std::optional<FilePath>;
  m.def(
      "write_report",
      [](const RunReader& run, const Path& file, const Path& json, const Path& junit, bool pictures,
         const Report& progress, const Cancel& cancel) {
        ReportFiles files;
        if (file) files.page = *file;
        if (json) files.json = *json;
        if (junit) files.junit = *junit;
        files.pictures = pictures;
        return write(run, files, progress, cancel);
      },
      "run"_a, "file"_a = nb::none(), nb::kw_only(), "json"_a = nb::none(), "junit"_a = nb::none(),
      "pictures"_a = true, "progress"_a = nb::none(), "cancel"_a = nb::none(),
      "Examines a run, finished or not, and returns its report: what was simulated, the sources of its\n"
      "numbers, and a verdict per promise, as `muslin report` has it. file: an HTML page to write; json, "
      "junit:\nfiles for programs and pipelines. pictures: in the page.");
}

}  // namespace muslin::python
