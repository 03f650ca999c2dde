// Writes the report of a run to files, as `muslin report` does.
#pragma once

#include <filesystem>

#include "muslin/cache/run_reader.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/report/run_report.hpp"

namespace muslin {

struct ReportFiles {
  std::filesystem::path page;   ///< HTML; empty: none
  std::filesystem::path json;   ///< empty: none
  std::filesystem::path junit;  ///< XML; empty: none
  bool pictures = true;         ///< in the page
};

/// Examines a run and writes the files, each whole or not at all. Errors: as make_report; file.
RunReport write_report(const RunReader& run, const ReportFiles& files, const Progress& progress);

}  // namespace muslin
