// RunReport is the certificate of a run: what was simulated, from which numbers, and which promises it kept.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "muslin/cache/run_reader.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/report/energy_turnover.hpp"
#include "muslin/report/fabric_sources.hpp"
#include "muslin/report/promises.hpp"
#include "muslin/report/run_evidence.hpp"

namespace muslin {

struct RunReport {
  std::string title;  ///< of the run, or the name of its directory
  RunEvidence evidence;
  std::vector<Promise> promises;
  std::vector<Fabric> fabrics;
  EnergyTurnover energy;

  std::size_t count(Verdict verdict) const;
};

/// Examines a run, finished or not. Errors: file; input, if a file is damaged; interrupted.
RunReport make_report(const RunReader& run, const Progress& progress);

/// Returns the report as JSON; docs/guide/report.md describes it. Numbers in SI; null where there is none.
nlohmann::ordered_json report_json(const RunReader& run, const RunReport& report);

/// Returns the promises as a test suite in the XML of JUnit: broken ones are failures, unmeasured ones
/// skipped.
std::string report_junit(const RunReport& report);

}  // namespace muslin
